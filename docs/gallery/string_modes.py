"""Natural modes of a taut string, about its equilibrium."""

import ancf

model = ancf.Model()
section = ancf.Section(EA=1e5, EI=1e-3, rhoA=0.01)
string = model.add_beam("string", start=(0, 0, 0), end=(1, 0, 0), elements=16, length=0.999, section=section)
model.pin(string.start)
model.pin(string.end)

modes = ancf.modes(model, about=ancf.equilibrium(model), count=4)
modes.plot(4).save("string_modes.png")
