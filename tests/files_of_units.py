"""Model files that are exported as units of co-simulation."""

#: A rope that an input pulls, from its equilibrium.
MODEL = """
title = "A rope that \\"an input\\" pulls"
gravity = [0, 0, -9.81]

[[inputs]]
name = "thrust"
value = 0.5
unit = "N"
description = "pull of the drive"

[[inputs]]
name = "lift"

[[bodies]]
type = "beam"
name = "rope"
start = [0, 0, 0]
end = [0, 0, -2]
elements = 3
section = { EA = 1e4, EI = 0.1, rhoA = 0.5 }

[[bodies]]
type = "point_mass"
name = "load"
at = [0, 0, -1.5]
mass = 2.0

[[supports]]
type = "pin"
point = "rope.start"

[[connections]]
type = "spherical"
name = "hook"
a = "rope.at(1.5)"
b = "load"

[[connections]]
type = "spring"
name = "tie"
a = "rope.at(1)"
b = [1, 0, -1]
stiffness = 5.0

[[loads]]
type = "force"
point = "load"
force = ["thrust + 0.1*sin(t)", 0, "lift"]

[simulation]
t_end = 1.0
step = 1e-3
start = "equilibrium"
sensors = ["rope.end", "rope.at(1)", "load", "tie", "hook"]
"""
#: A load on a rope that a winch hauls in as it is told.
HOIST = """
gravity = [0, 0, -9.81]

[[inputs]]
name = "speed"

[[bodies]]
name = "rope"
start = [0, 0, 0]
end = [0.3, 0, -2.98]
length = 3.0
elements = 4
section = { EA = 1e4, EI = 1e-3, rhoA = 0.05, axial_damping = 2.0 }

[[bodies]]
type = "point_mass"
name = "load"
at = [0.3, 0, -2.98]
mass = 1.0

[[supports]]
type = "pin"
name = "drum"
point = "rope.start"

[[supports]]
type = "winch"
point = "rope.start"
length = 3.0
speed = "speed"
acceleration = 2.0

[[connections]]
type = "spherical"
name = "hook"
a = "rope.end"
b = "load"

[simulation]
t_end = 1.0
step = 2e-3
sensors = ["rope.start", "load", "drum"]
"""
#: A rope on a floor, a ball on it, and a body on a torsion spring.
TOUCHING = """
gravity = [0, 0, -9.81]

[[bodies]]
name = "rope"
start = [0, 0, 0.01]
end = [1, 0, 0.01]
elements = 3
section = { EA = 1e4, EI = 0.1, rhoA = 0.5, diameter = 0.02 }

[[bodies]]
type = "rigid_body"
name = "ball"
at = [0, 2, 0.099]
mass = 1.0
inertia = [0.01, 0.01, 0.01]

[[surfaces]]
name = "floor"
shape = "plane"

[[surfaces]]
name = "skin"
shape = "sphere"
radius = 0.1
on = "ball"

[[connections]]
type = "surface_contact"
name = "rest"
body = "rope"
surface = "floor"
stiffness = 1e5
friction = 0.3

[[connections]]
type = "body_contact"
name = "bump"
surface = "skin"
other = "floor"
stiffness = 1e4
friction = 0.3

[[connections]]
type = "torsion_spring"
name = "twist"
a = "ball"
b = [0, 2, 0.099]
axis = [1, 0, 0]
stiffness = 1.0

[simulation]
t_end = 1.0
step = 1e-3
sensors = ["rest", "bump", "twist"]
"""
