"""A trolley on a slack rope: where it is, and the rope below it."""

import ancf

model = ancf.Model(gravity=(0, 0, -9.81))
steel = ancf.Section(EA=1e5, EI=0.1, rhoA=0.3, axial_damping=100.0)
rope = model.add_beam("rope", start=(0, 0, 0), end=(20, 0, -1), elements=20, length=20.3, section=steel)
model.pin(rope.start)
model.pin(rope.end)
trolley = model.add_point_mass("trolley", at=(4, 0, -0.2), mass=5.0)
model.slide(trolley, along=rope, tolerance=1.0)
model.hold(trolley, position="x", name="brake")
start = ancf.equilibrium(model)
model.supports.remove(model.supports[-1])

result = ancf.simulate(
    model, t_end=6.0, step=2e-3, start=start, integrator=ancf.GeneralizedAlpha(rho_inf=0.8)
)
result.plot_shape(7, plane="xz").save("ropeway.png")
