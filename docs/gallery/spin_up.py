"""A helicopter blade spins up: its tip lags behind, then centrifugal force pulls it straight."""

import numpy as np

import ancf
from ancf.viz import style

model = ancf.Model()
section = ancf.Section(EA=5.03e6, EI=566.2, rhoA=0.2019)
blade = model.add_beam("blade", start=(0, 0, 0), end=(8, 0, 0), elements=8, section=section)


def angle(t):
    return 4.0 / 15.0 * (t**2 / 2 + (15 / (2 * np.pi)) ** 2 * (np.cos(2 * np.pi * t / 15) - 1))


model.clamp(blade.start, rotation=angle, axis=(0, 0, 1))
result = ancf.simulate(model, t_end=15.0, step=5e-3)

tip, turn = result.position(blade.end), np.array([angle(t) for t in result.t])
with style.new_figure(120, 70) as figure:
    axes = figure.subplots()
    lag = np.cos(turn) * tip[:, 1] - np.sin(turn) * tip[:, 0]
    axes.plot(result.t, lag, color=style.BLUE)
    axes.set(xlabel="time [s]", ylabel="tip beside the turning axis [m]")
    figure.savefig("spin_up.png")
