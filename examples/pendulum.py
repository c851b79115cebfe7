"""Example 7.2 of the paper: a flexible pendulum in space, released while it turns about the vertical."""

import ancf


def build(elements: int = 4, f: float = 5.0) -> ancf.Model:
    side = 1e-3 * f  # m
    section = ancf.Section.rectangle(side, side, E=1e9 / f**4, rho=8000.0 / f**2)
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    rope = model.add_beam(
        "rope", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section, strain="paper"
    )
    rope.set_motion(angular_velocity=(0, 0, 4.0), about=(0, 0, 0))  # rad/s
    model.pin(rope.start)
    return model


def main(t_end: float = 2.0) -> None:
    result = ancf.simulate(build(), t_end=t_end, step=1e-4, output_step=1e-3)
    tip, middle = result.position("rope.end"), result.position("rope.at(0.5)")
    for i in range(0, len(result.t), max(len(result.t) // 4, 1)):
        print(f"t = {result.t[i]:.3f} s: tip {tip[i].round(6)} m, middle {middle[i].round(6)} m")
    print(f"largest tension at the pin: {result.tension('rope.start').max():.3f} N")
    print(f"{result.stats.steps} steps, {result.stats.jacobians} Jacobians")


if __name__ == "__main__":
    main()
