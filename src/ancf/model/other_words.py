"""Words of other programs that users try, and what does it here."""

from __future__ import annotations

from collections.abc import Collection, Mapping

#: Methods of a Model, by a word of the name that was tried.
OF_MODEL = {
    "seabed": "add_ground(...) makes a seabed",
    "floor": "add_ground(...) makes a floor",
    "ground": "add_ground(...) makes a ground; joints and springs end on it at a place (x, y, z)",
    "buoy": "add_rigid_body(...) or add_point_mass(...) makes a buoy, add_fluid(...) the water",
    "buoyancy": "add_beam(...) with a section of a larger diameter floats, see ancf docs buoyancy",
    "clump": "add_point_mass(...) makes a clump weight, connect(...) ties it to a node",
    "vessel": "add_rigid_body(...) makes a vessel, clamp(..., displacement=..., rotation=...) moves it",
    "weld": "weld(...) joins two bodies, clamp(...) holds one in space",
    "ship": "add_rigid_body(...) makes a ship, clamp(..., displacement=..., rotation=...) moves it",
    "anchor": "pin(...) holds an anchor",
    "fairlead": "pin(...) holds a fairlead, connect(...) ties it to a vessel",
    "cable": 'add_beam(...) makes a cable, element="cable" by default',
    "rope": 'add_beam(...) makes a rope, element="cable" by default',
    "line": 'add_beam(...) makes a line, element="cable" by default',
    "chain": "add_beam(...) makes a chain, of a section with EI=0",
    "wire": 'add_beam(...) makes a wire, element="cable" by default',
    "mooring": "add_beam(...) makes a mooring line, see ancf docs mooring",
    "riser": "add_beam(...) makes a riser, or pieces of it that weld(...) joins, see ancf docs riser",
    "tendon": "add_beam(...) makes a tendon, add_contact(...) or slide(...) leads it, winch(...) pulls it",
    "rod": 'add_beam(...) makes a rod, element="nonlocking" has torsion',
    "link": "add_beam(...) makes a flexible link, add_rigid_body(...) a rigid one",
    "arm": "add_beam(...) makes a flexible arm, add_rigid_body(...) a rigid one",
    "rigid": "add_rigid_body(...) makes a rigid body",
    "body": "add_rigid_body(...) makes a rigid body, add_beam(...) a flexible one",
    "pulley": "add_surface(...) and add_contact(...) make a pulley",
    "sheave": "add_surface(name, ancf.Sheave(...)) and add_contact(...) make a sheave",
    "drum": "add_surface(...) and add_contact(...) make a drum",
    "cylinder": "add_surface(name, ancf.Cylinder(...)) makes a cylinder that cables touch",
    "winch": "winch(...) pays out and hauls in",
    "water": "add_fluid(...) makes water",
    "sea": "add_fluid(..., waves=...) makes a sea",
    "fluid": "add_fluid(...) makes a fluid",
    "drag": "add_fluid(...) makes the fluid, ancf.Section(..., drag=(1.2, 0.01)) has coefficients",
    "current": "add_fluid(..., velocity=...) has a current",
    "wave": "add_fluid(..., waves=...) has waves",
    "waves": "add_fluid(..., waves=...) has waves",
    "wind": "add_fluid(..., velocity=...) has a wind",
    "motor": "clamp(..., rotation_vector=...) turns as functions of time say",
    "actuator": "add_moment(...) or add_force(...) acts, as an input of add_input(...) says",
    "controller": "add_input(...) makes what it gives, ancf.simulate(..., controller=...) calls it",
    "torque": "add_moment(...) acts as a torque",
    "encoder": "hinge(...) has an angle: joint_angle(hinge) of results and runs; see ancf docs encoder",
    "sensor": "sensor(...) looks one up; ancf.simulate(..., sensors=[...]) records",
    "joint": "hinge(...), connect(...), prismatic(...), universal(...), weld(...) and slide(...) are joints",
    "revolute": "hinge(...) turns about an axis",
    "spherical": "connect(...) is a spherical joint",
    "ball": "connect(...) is a ball joint",
    "cardan": "universal(...) is a Cardan joint",
    "slider": "slide(...) lets a point slide along a line, prismatic(...) a body along an axis",
    "attach": "connect(...) joins points, weld(...) holds directions as well",
    "tie": "connect(...) joins points, weld(...) holds directions as well",
    "glue": "weld(...) joins points and holds their directions",
    "support": "pin(...), clamp(...) and hold(...) are supports",
    "encastre": "clamp(...) holds position and direction",
    "fix": "clamp(...) holds position and direction, pin(...) the position",
    "damper": "add_spring(..., damping=...) damps, add_torsion_spring(..., damping=...) what turns",
    "torsional": "add_torsion_spring(...) resists turning",
    "mass": "add_point_mass(...) or add_rigid_body(...)",
    "gravity": "gravity is given to ancf.Model(gravity=(0, 0, -9.81))",
    "velocity": "bodies of a model have it: body.set_motion(velocity=...)",
    **dict.fromkeys(
        ("break", "cut", "disconnect", "release", "detach", "remove"),
        "a model without that joint starts from the state of the run before, see ancf docs rope breaks",
    ),
    "save": "to_dict() describes a model, ancf.Model.from_dict(...) makes it again",
    "run": "ancf.simulate(model, t_end=..., step=...) runs it",
    "simulate": "ancf.simulate(model, t_end=..., step=...) runs it",
    "solve": "ancf.equilibrium(model) and ancf.simulate(model, t_end=..., step=...) solve it",
    "plot": "ancf.equilibrium(model).plot() draws its equilibrium",
}

#: Questions to states and results.
OF_RESULT = {
    "reactions": "reaction(support) is the force of one, reaction_moment(support) the moment of a clamp",
    "force": "tension(point), reaction(support), spring_force(spring), joint_force(joint)",
    "forces": "tension(point), reaction(support), spring_force(spring), joint_force(joint)",
    "moment": "bending_moment(point), section_moment(point), joint_moment(joint), reaction_moment(support)",
    "moments": "bending_moment(point), section_moment(point), joint_moment(joint), reaction_moment(support)",
    "stress": "stress_tensor(point) of a beam with a cross-section; of a cable tension(point) over its area",
    "length": "natural_length(cable), spring_length(spring)",
    "displacement": "position(point) less that at the start",
    "rotation": "section_rotation(point), its axes as columns; joint_angle(hinge), twist(point)",
    "orientation": "section_rotation(body), its axes as columns",
    "quaternion": "section_rotation(body), of which scipy's Rotation.from_matrix(...).as_quat() makes them",
    "euler": 'section_rotation(body), of which scipy\'s Rotation.from_matrix(...).as_euler("xyz") makes them',
    "travel": "joint_displacement(joint) of a prismatic one, arc_length(joint) of a sliding one",
    "stroke": "joint_displacement(joint) of a prismatic one, arc_length(joint) of a sliding one",
    "angle": "joint_angle(hinge), twist(point) of a beam, torsion_angle(spring)",
    "tensions": "tension(point) of each point, such as [tension(line.at(x)) for x in ...]",
    "range": "tension(line.at(x)).max() for each x, see ancf docs range graph",
    "envelope": "tension(line.at(x)).max() for each x, see ancf docs range graph",
    "max": "tension(point).max() and so on",
    "energy": "energy.kinetic, .strain, .potential, .total",
    "time": "t",
    "times": "t",
    "x": "position(point)[..., 0]",
    "y": "position(point)[..., 1]",
    "z": "position(point)[..., 2]",
    "coordinates": "position(point)",
    "export": "to_csv(...), to_excel(...), to_pandas(), to_xarray() of a result; the command ancf export",
    "csv": "to_csv(...) of a result",
    "video": 'animate().save("motion.gif") or .mp4',
    "movie": 'animate().save("motion.gif") or .mp4',
    "gif": 'animate().save("motion.gif")',
    "shape": "plot() of a state, plot_shape() of a result",
}

#: What the package offers, by what was asked of it.
OF_PACKAGE = {
    "run": "simulate(model, t_end=..., step=...)",
    "solve": "equilibrium(model), simulate(model, t_end=..., step=...)",
    "static": "equilibrium(model)",
    "statics": "equilibrium(model)",
    "modal": "modes(model)",
    "eigen": "modes(model)",
    "frequencies": "modes(model).frequencies_hz",
    "export": "result.to_csv(...), result.to_pandas(); the command ancf export writes more",
    "fmu": "the command ancf export-fmu FILE writes a unit of a model file",
    "plot": "result.plot(...), state.plot(), result.plot_shape()",
    "video": 'result.animate().save("motion.gif")',
    "animate": 'result.animate().save("motion.gif")',
    "compare": "result.compare(other)",
    "csv": 'Series.read("file.csv", "column")',
    "wave": "Waves.regular(...), Waves.jonswap(...)",
    "jonswap": "Waves.jonswap(...)",
    "current": "model.add_fluid(..., velocity=...)",
    "drum": "Cylinder(...) of model.add_surface(...)",
    "pulley": "Sheave(...) of model.add_surface(...)",
    "optimize": "minimise(...)",
    "minimize": "minimise(...)",
    "fit": "calibrate(...)",
    "pid": "simulate(..., controller=..., control_step=...) calls a function or an object",
    "controller": "simulate(..., controller=..., control_step=...) calls a function or an object",
    "error": "ModelError, SolveError",
    "cable": "model.add_beam(...)",
    "mpm": "see ancf docs MPM",
    "rainflow": "see ancf docs rainflow",
    "view": "result.view(); the command ancf view",
}

_ONE_WAVE = "Waves.regular(height=, period=) is one linear wave, after Airy"
_SEA = "Waves.jonswap(height=, period=) or Waves.pierson_moskowitz(height=, period=) is an irregular sea"
_MOMENTS = "Section.from_moments(A=, I_y=, I_z=, ...) has any shape with two axes of symmetry"
#: What classes offer, by what was asked of them.
OF_CLASSES = {
    "Waves": {
        **dict.fromkeys(("airy", "linear", "sine", "harmonic", "monochromatic", "single"), _ONE_WAVE),
        **dict.fromkeys(("stokes", "stream", "cnoidal"), f"waves are linear: {_ONE_WAVE}"),
        **dict.fromkeys(("irregular", "random", "spectrum", "sea", "torsethaugen"), _SEA),
        **dict.fromkeys(
            ("pm", "pierson", "bretschneider", "issc"),
            "Waves.pierson_moskowitz(height=, period=)",
        ),
    },
    "Section": {
        **dict.fromkeys(("tube", "pipe", "hollow", "annulus", "moments", "i", "h", "profile"), _MOMENTS),
        **dict.fromkeys(
            ("round", "rod", "wire", "circular", "disk"), "Section.circle(diameter=, E=, rho=) is round"
        ),
        **dict.fromkeys(("rope", "chain", "cable"), "Section(EA=, EI=, rhoA=) takes what a data sheet says"),
        **dict.fromkeys(("square", "box", "rectangular"), "Section.rectangle(width=, height=, E=, rho=)"),
    },
    "Series": dict.fromkeys(("csv", "load", "file"), 'Series.read("file.csv", "column") reads one'),
}

#: Arguments, in small letters, and what they may be called here: the first that a call knows.
OF_ARGUMENTS = {
    "dt": ("step",),
    "timestep": ("step",),
    "time_step": ("step",),
    "tmax": ("t_end",),
    "t_max": ("t_end",),
    "tend": ("t_end",),
    "time": ("t_end",),
    "duration": ("t_end",),
    "hs": ("height",),
    "h": ("height", "step"),
    "tp": ("period",),
    "t": ("period", "t_end", "times"),
    "points": ("items",),
    "columns": ("items",),
    "cd": ("drag",),
    "ca": ("added_mass",),
    "cm": ("added_mass",),
    "od": ("diameter",),
    "d": ("diameter",),
    "mass": ("rhoA", "rho"),
    "m": ("rhoA", "mass"),
    "weight": ("rhoA", "mass"),
    "density": ("rho",),
    "n": ("elements", "count"),
    "n_elements": ("elements",),
    "num_elements": ("elements",),
    "l": ("length",),
    "l0": ("length",),
    "position": ("at",),
    "pos": ("at",),
    "center": ("at",),
    "current": ("velocity",),
    "k": ("stiffness",),
    "c": ("damping",),
    "mu": ("friction",),
    "level": ("height",),
    "z": ("height",),
    "solver": ("integrator",),
    "dt_out": ("output_step",),
    "output_dt": ("output_step",),
    "control_dt": ("control_step",),
    "sample_time": ("control_step",),
    "initial": ("start",),
    "x0": ("start",),
    "n_jobs": ("workers",),
    "processes": ("workers",),
}
#: Joints, and arguments that springs beside them have.
TURNING = ("hinge", "cylindrical", "planar", "universal")
RESISTING = ("stiffness", "damping", "friction", "k", "c", "spring")
#: What is said of an argument that a call wants, by both.
WANTED = {
    ("winch", "length"): (
        "length= is what is paid out at the start, m, such as length=line.length, beside speed= and"
        " acceleration= of its drive; or alone a function of time, such as length='10 - 0.1*t'"
    ),
}
#: What is said of a call, or of an argument that nothing here is called.
TOLD = {
    "Waves": "Waves.regular(...), Waves.jonswap(...) or Waves.pierson_moskowitz(...) makes them",
    "amplitude": "the height is twice the amplitude",
    "buoyancy": "it follows from the diameter and the density of the fluid",
    "controller": "ancf.simulate takes one, also in a build function that returns numbers of its run",
    "youngs_modulus": "the modulus of elasticity is E",
}


def hint_of(name: str, words: Mapping[str, str]) -> str:
    """What does what a name says, by one of its words, "" if nothing is known."""
    return next((words[word] for word in name.lower().split("_") if word in words), "")


def method_of(name: str, methods: Collection[str]) -> str:
    """A method of nearly that name: with or without ``add_``, in small letters; "" if there is none."""
    small = name.lower()
    tried = (small, small.removeprefix("add_"), f"add_{small}")
    return next((f"{word}(...) is its name" for word in tried if word != name and word in methods), "")


def argument_of(where: str, name: str, known: Collection[str]) -> str:
    """What an argument is called here, 'did you mean "step"?', or what has it, or nothing."""
    found = next((word for word in OF_ARGUMENTS.get(name.lower(), ()) if word in known), "")
    if found:
        return f'did you mean "{found}"?'
    if where in TURNING and name in RESISTING:
        return "model.add_torsion_spring(...) beside it has stiffness and damping"
    return TOLD.get(where) or TOLD.get(name.lower(), "")
