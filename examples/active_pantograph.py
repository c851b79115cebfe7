"""An active pantograph: a PID controller moves its frame, which lowers the deviation of the contact force.

The reference model of EN 50318:2002 runs along its line at 250 km/h. The controller looks at the contact
force as a sensor would give it, behind a low-pass filter, and pushes the lowest mass with at most 100 N.
"""

from __future__ import annotations

import numpy as np

from ancf import catenary

LINE, PANTOGRAPH = "en50318-2002", "en50318-2002"
SPEED = 250 / 3.6  # m/s
CONTROL_STEP = 2e-3  # s
#: Of the error, of its integral in 1/s, of its rate in s.
GAINS = (2.0, 1.0, 0.005)


class PID:
    """Force on the frame from the contact force.

    Parameters
    ----------
    wanted : float
        Contact force, N.
    gains : (float, float, float)
        Of the error, of its integral in 1/s, of its rate in s.
    most : float
        Largest force, N.
    corner : float
        Of the filter of the sensor, Hz.
    """

    def __init__(self, wanted, gains=GAINS, most=100.0, corner=20.0):
        self.wanted, self.gains, self.most = wanted, gains, most
        self.share = 1.0 - np.exp(-2.0 * np.pi * corner * CONTROL_STEP)
        self.seen, self.before, self.total = wanted, wanted, 0.0

    def __call__(self, run):
        self.before = self.seen
        self.seen += self.share * (float(run.contact_force("pantograph contact")) - self.seen)
        error, (p, i, d) = self.wanted - self.seen, self.gains
        total = self.total + error * CONTROL_STEP
        force = p * error + i * total - d * (self.seen - self.before) / CONTROL_STEP
        if abs(force) < self.most:
            self.total = total  # it does not wind up while the force is at its limit
        run.inputs["pantograph_force"] = float(np.clip(force, -self.most, self.most))


def passage(controller=None, **given):
    """The pantograph passes; a Run."""
    led = {} if controller is None else {"controller": controller, "control_step": CONTROL_STEP}
    return catenary.run(LINE, speed=SPEED, pantograph=PANTOGRAPH, **led, **given)


if __name__ == "__main__":
    passive = catenary.statistics(passage())
    active = catenary.statistics(passage(PID(wanted=passive["mean_force"].value)))
    for name, found in (("passive", passive), ("active", active)):
        mean, deviation = found["mean_force"].value, found["deviation"].value
        print(f"{name}: mean force {mean:.1f} N, standard deviation {deviation:.1f} N")
