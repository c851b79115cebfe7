"""The free end of a soft rope that swings about a hook, in space."""

import ancf

model = ancf.Model(gravity=(0, 0, -9.81))
section = ancf.Section(EA=40.0, EI=8.333e-5, rhoA=0.008)
rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section)
model.pin(rope.start)
rope.set_motion(angular_velocity=(0, 0, 4))

result = ancf.simulate(model, t_end=4.0, step=5e-4)
result.plot(rope.end, plane="xyz").save("pendulum_path.png")
