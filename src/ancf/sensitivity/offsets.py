"""Values around that of a parameter, with which forces are differentiated by it."""

from __future__ import annotations

#: Step of the differences, relative, and of a parameter that is zero, in its unit or the size of the model.
STEP = 1e-3
#: Places of the values in steps, and weights of the derivative of order six: on both sides, on one.
BOTH = ((-3.0, -2.0, -1.0, 1.0, 2.0, 3.0), (-1 / 60, 9 / 60, -45 / 60, 45 / 60, -9 / 60, 1 / 60))
#: The same of order four, where that is seen to do.
FOUR = (-3.0, -1.5, 1.5, 3.0), (1 / 18, -8 / 18, 8 / 18, -1 / 18)
ABOVE = (
    (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0),
    (-147 / 60, 360 / 60, -450 / 60, 400 / 60, -225 / 60, 72 / 60, -10 / 60),
)
#: The same, as a share of these steps, where powers of lengths have effects that nearly cancel.
STEEP = 0.2
#: The same where a turned clamp bends a cable with bending damping, which changes within 1e-2 rad an element.
BENT = 0.03
#: The step where forces have kinks, which no value may reach: a taut dropper is stretched by 0.1 mm.
TINY = 1e-7
#: The same where all is linear; energies are quadratic then.
PAIR = ((-3.0, 3.0), (-1 / 6, 1 / 6))
#: Names of the parts whose forces have kinks.
KINKED = {
    "springs",
    "contacts",
    "pressing",
    "rubbing",
    "crossing",
    "gripping",
    "bumping",
    "rolling",
    "ground",
}
