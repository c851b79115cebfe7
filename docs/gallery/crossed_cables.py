"""A cable falls across another one: they touch, and hang together."""

import ancf

model = ancf.Model(gravity=(0, 0, -9.81))
rope = ancf.Section(EA=1e4, EI=1e-2, rhoA=0.2, diameter=0.02, axial_damping=20.0, damping=0.2)
low = model.add_beam("low", start=(-1, 0, 0), end=(1, 0, 0), elements=12, length=2.1, section=rope)
high = model.add_beam("high", start=(0, -1, 0.2), end=(0, 1, 0.2), elements=12, length=2.4, section=rope)
for end in (low.start, low.end, high.start, high.end):
    model.pin(end)
model.add_contact(low, high, stiffness=1e5, damping=100.0)

result = ancf.simulate(model, t_end=1.0, step=2e-3, integrator=ancf.GeneralizedAlpha(rho_inf=0.5))
result.state(-1).plot(color="tension", plane="xyz").save("crossed_cables.png")
