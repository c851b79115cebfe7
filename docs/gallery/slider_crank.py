"""A slider-crank with a soft connecting rod: the slider beside that of a rigid one."""

import numpy as np

import ancf
from ancf.viz import style

model = ancf.Model()
soft = ancf.Section(EA=1.2e5, EI=1.0, rhoA=0.162, axial_damping=300.0, bending_damping=1e-3)
rod = model.add_beam("rod", start=(0.15, 0, 0), end=(0.65, 0, 0), elements=6, section=soft)
crank = model.add_rigid_body("crank", at=(0.075, 0, 0), mass=0.4, inertia=(1e-4, 8e-4, 8e-4))
pivot = model.clamp(
    crank,
    rotation=lambda t: -15 * t,
    axis=(0, 1, 0),
    displacement=lambda t: (0.075 * (np.cos(15 * t) - 1), 0, 0.075 * np.sin(15 * t)),
)
slider = model.add_point_mass("slider", at=(0.65, 0, 0), mass=0.5)
model.connect(crank.at(0.075, 0, 0), rod.start)
model.connect(slider, rod.end)
model.hold(slider, position="yz")
rod.set_motion(angular_velocity=(0, 4.5, 0), about=(0.65, 0, 0))
result = ancf.simulate(model, t_end=0.84, step=5e-4, integrator=ancf.GeneralizedAlpha(rho_inf=0.8))

rigid = 0.15 * np.cos(15 * result.t) + np.sqrt(0.25 - (0.15 * np.sin(15 * result.t)) ** 2)
with style.new_figure(120, 70) as figure:
    axes = figure.subplots()
    axes.plot(result.t, 1e3 * (result.position(slider)[:, 0] - rigid), color=style.BLUE)
    axes.set(xlabel="time [s]", ylabel="slider beside that of a rigid rod [mm]")
    figure.savefig("slider_crank.png")
