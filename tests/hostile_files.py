"""Write the files of tests/data/hostile: ``python tests/hostile_files.py`` from the root of the repository.

Models and lines that stood, or stand near, for an error without a place; results files that are cut off,
damaged, or keep their data elsewhere. `tests/bad_input/test_hostile.py` gives each of them to ``ancf check``.
"""

import json

import h5py
import numpy as np

from places import DATA

FOLDER = DATA / "hostile"

BODY = """
[[bodies]]
name = "beam"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 3
section = "s"
"""
SECTION = """
[sections.s]
EA = 1e3
EI = 0.1
rhoA = 0.05
"""
CLAMP = """
[[supports]]
type = "clamp"
point = "beam.start"
"""
RUN = """
[simulation]
t_end = 0.01
step = 1e-3
"""
MODEL = SECTION + BODY + CLAMP + RUN
JOINT = '\n[[bodies]]\ntype = "point_mass"\nname = "w{k}"\nmass = 0.1\nat = [1, 0, 0]\n'
JOINED = '\n[[connections]]\ntype = "spherical"\na = "beam.end"\nb = "w{k}"\nname = {name}\n'
LINE = """
system_height = 1.2
[contact_wire]
EA = 15e6
EI = 195.0
mass = 1.35
tension = 20e3
[messenger_wire]
EA = 11.6e6
EI = 131.7
mass = 1.07
tension = 16e3
[droppers]
stiffness = 100e3
[steady_arm]
vertical = 300.0
[[spans]]
repeat = 3
length = 60.0
droppers = [5.0, 17.0, 30.0, 43.0, 55.0]
"""
SPAN = "\n[[spans]]\nrepeat = 1000\nlength = 60.0\ndroppers = [5.0, 30.0, 55.0]\n"


def joined(*names):
    """A model with joints of these names."""
    parts = [JOINT.format(k=k) + JOINED.format(k=k, name=json.dumps(n)) for k, n in enumerate(names)]
    return SECTION + BODY + "".join(parts) + CLAMP + RUN


def path(points):
    return MODEL.replace("start = [0, 0, 0]\nend = [1, 0, 0]", f"path = {points}")


def models():
    """Texts of model files by name."""
    yield "joint_names", joined("a/b", "//a", ".", "..", "/", "a", "bodies", "x" * 1000)
    yield "joint_formulas", joined("=1+1", "+a", "-a", "@a", "=cmd|' /C calc'!A0")
    yield "title_with_escapes", 'title = "\\u001b[31m\\u001b]0;own\\u0007 \\u009b2J \\u202etxet"' + MODEL
    yield "name_with_escapes", joined("a\x1b[2J")
    yield "path_back", path([[0, 0, 0], [1, 1, 0], [1.05, 0, 0], [0, 0, 0]])
    yield "path_uneven", path([[0, 0, 0], [1, 1, 0], [1.0001, 1, 0], [5, -3, 1], [5, -3, 1.001]])
    yield "path_doubled", path([[0, 0, 0], [1, 0, 0], [1, 0, 0], [2, 0, 0]])
    yield "path_far", path([[0, 0, 0], [1e90, 0, 0], [1e101, 0, 0]])
    yield "output_step_endless", MODEL + "output_step = 1e30\n"
    yield "output_step_overflow", MODEL.replace("1e-3", "1e-7") + "output_step = 1e308\n"
    yield "output_step_between", MODEL + "output_step = 1.5e-3\n"
    yield "step_tiny", MODEL.replace("1e-3", "5e-324")
    stiff = MODEL.replace("EI = 0.1", "EI = 1e150")
    yield "explicit_very_stiff", stiff + 'integrator = "explicit"\n'
    yield "stiffness_overflow", MODEL.replace("EA = 1e3", "EA = 1e308")
    yield "stiffness_beyond", MODEL.replace("EA = 1e3", "EA = 1e400")
    yield "formulation_list", MODEL + 'integrator = {type = "trapezoidal", formulation = ["ggl"]}\n'
    yield "integrator_list", MODEL + 'integrator = ["trapezoidal", "radau"]\n'
    yield "elements_endless", MODEL.replace("elements = 3", "elements = 99999999999999999999")
    yield "elements_text", MODEL.replace("elements = 3", 'elements = "3"')
    yield "numbers_that_are_none", MODEL.replace("end = [1, 0, 0]", "end = [nan, inf, -inf]")
    yield "point_far_away", MODEL.replace("end = [1, 0, 0]", "end = [1e200, 0, 0]")
    yield "point_of_a_date", MODEL.replace("end = [1, 0, 0]", "end = [1, 0, 2001-01-01]")
    yield "beam_without_length", MODEL.replace("end = [1, 0, 0]", "end = [0, 0, 0]")
    yield "name_long", MODEL.replace("beam", "b" * 1000)
    yield "name_with_slash", MODEL.replace('"beam"', '"a/b"').replace("beam.start", "a/b.start")
    yield "table_as_number", MODEL.replace("[simulation]\n", "simulation = 3\n#")
    yield "key_twice", MODEL + "step = 1e-3\n"
    yield "nested_deeply", "a = " + "[" * 3000 + "]" * 3000
    yield "nothing", ""
    yield "no_toml", "%PDF-1.4 \\ {"
    function = '\n[[loads]]\ntype = "force"\npoint = "beam.end"\nforce = ["{f}", 0, 0]\n'
    yield "function_import", MODEL + function.format(f="__import__('os').system('true')")
    yield "function_power", MODEL + function.format(f="9**9**9**9")
    yield "function_nested", MODEL + function.format(f="(" * 500 + "t" + ")" * 500)


def lines():
    """Texts of line files by name."""
    yield "line_right", LINE
    yield "line_span_endless", LINE.replace("length = 60.0", "length = 1e20")
    yield "line_span_long", LINE.replace("length = 60.0", "length = 1e6")
    yield "line_spans_many", LINE + 40 * SPAN
    yield "line_spans_empty", "spans = []\n" + LINE.split("[[spans]]")[0]
    yield "line_span_bare", LINE.split("[[spans]]")[0] + "\n[[spans]]\nlength = 60.0\ndroppers = []\n"
    yield "line_dropper_rule_half", LINE.replace("[5.0, 17.0, 30.0, 43.0, 55.0]", "{first = 5.0}")
    yield (
        "line_droppers_many",
        LINE.replace("[5.0, 17.0, 30.0, 43.0, 55.0]", str([0.1 + 0.06 * k for k in range(900)])),
    )
    yield "line_droppers_back", LINE.replace("[5.0, 17.0", "[17.0, 5.0")
    yield "line_dropper_outside", LINE.replace("55.0]", "61.0]")
    yield "line_tension_none", LINE.replace("tension = 20e3", "tension = 1e-300")
    yield "line_tension_endless", LINE.replace("tension = 16e3", "tension = 1e308")
    yield "line_mass_endless", LINE.replace("mass = 1.35", "mass = 1e308")
    yield "line_mass_beyond", LINE.replace("mass = 1.35", "mass = 1e999")
    yield "line_height_low", LINE.replace("system_height = 1.2", "system_height = 0.01")
    yield "line_height_list", LINE.replace("system_height = 1.2", "system_height = [1.2, 1.2]")
    yield "line_height_endless", LINE.replace("system_height = 1.2", "system_height = 1e308")
    yield "line_gravity_endless", "gravity = 1e308\n" + LINE
    yield "line_stagger_words", 'stagger = ["a"]\n' + LINE
    yield "line_pre_sag_deep", LINE + "pre_sag = 1e9\n"
    yield "line_stiffness_list", LINE.replace("stiffness = 100e3", "stiffness = [1, 2]")
    yield "line_title_with_escapes", 'title = "\\u001b[2J"\n' + LINE
    yield "line_messenger_only", "[messenger_wire]\nEA = 1.0\n"


def raw():
    """Bytes of files that are no text, by name."""
    yield "utf16.toml", MODEL.encode("utf-16")
    yield "latin.toml", 'title = "Größe"'.encode("latin-1")
    yield "nul.toml", MODEL.encode() + b"\0"
    yield "mark.toml", b"\xef\xbb\xbf" + MODEL.encode()
    yield "signature_only.h5", b"\x89HDF\r\n\x1a\n"
    yield "signature_and_zeros.h5", b"\x89HDF\r\n\x1a\n" + bytes(200)
    yield "text.h5", b"not HDF5 at all\n"


def small(path, damage=lambda file: None, killed=False):
    """A results file of one cable with three states, then damaged; `killed`: as its writer left it."""
    import ancf

    model = ancf.Model()
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=1e3, EI=0.1, rhoA=0.05)
    )
    model.clamp(beam.start)
    ancf.simulate(model, t_end=2e-3, step=1e-3).save(path)
    _shrink(path)
    with h5py.File(path, "r+", libver="latest") as file:
        damage(file)
    if killed:
        mark(path)


def _shrink(path):
    """Small chunks, so that the file is small too; what a run was is left out."""
    with h5py.File(path, "r") as old:
        data = {name: old[name][()] for name in ("time", "q", "v", "work", "energy")}
        header = json.loads(old.attrs["header"])
        header["versions"] = {}
        new = path.with_suffix(".new")
        with h5py.File(new, "w", libver="latest") as file:
            for key in ("format", "format_version"):
                file.attrs[key] = old.attrs[key]
            file.attrs["header"] = json.dumps(header)
            for name, values in data.items():
                file.create_dataset(
                    name, data=values, maxshape=(None, *values.shape[1:]), chunks=values.shape
                )
            for name in ("stats", "status", "bodies", "joints", "modes", "places"):
                old.copy(name, file)
    new.replace(path)


def mark(path):
    """Mark a file as being written."""
    from ancf.results.hdf5 import HEAD, MARKS, checksum

    data = bytearray(path.read_bytes())
    data[MARKS] = 5
    data[HEAD - 4 : HEAD] = checksum(bytes(data[: HEAD - 4])).to_bytes(4, "little")
    path.write_bytes(data)


def cut(path, share):
    path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])


def elsewhere(file):
    shape = file["q"].shape
    del file["q"]
    file.create_dataset("q", shape, "f8", external=[("/etc/passwd", 0, h5py.h5f.UNLIMITED)])


def virtual(file):
    layout = h5py.VirtualLayout(file["q"].shape, "f8")
    layout[:] = h5py.VirtualSource("/etc/passwd", "q", file["q"].shape)
    del file["q"]
    file.create_virtual_dataset("q", layout)


def replaced(name, value):
    def damage(file):
        del file[name]
        if value is not None:
            file[name] = value

    return damage


def attribute(name, value):
    def damage(file):
        file.attrs[name] = value

    return damage


def unknowns(file):
    file["bodies/beam/slots"][...] = 10**9


def no_number(file):
    file["q"][1, 3] = np.nan


DAMAGES = {
    "right": lambda file: None,
    "external_data": elsewhere,
    "external_link": replaced("v", h5py.ExternalLink("/etc/passwd", "/v")),
    "external_body": replaced("bodies", h5py.ExternalLink("other.h5", "/bodies")),
    "soft_link": replaced("energy", h5py.SoftLink("/energy")),
    "virtual_data": virtual,
    "without_q": replaced("q", None),
    "without_status": replaced("status", None),
    "status_unknown": replaced("status", 77),
    "stats_short": replaced("stats", np.zeros(2)),
    "q_of_words": replaced("q", np.array([b"a", b"b", b"c"])),
    "q_too_short": replaced("q", np.zeros((1, 18))),
    "q_flat": replaced("q", np.zeros(3)),
    "energy_narrow": replaced("energy", np.zeros((3, 1))),
    "no_states": replaced("time", np.zeros(0)),
    "no_number": no_number,
    "unknowns_outside": unknowns,
    "header_no_json": attribute("header", "{"),
    "header_list": attribute("header", "[1]"),
    "header_settings": attribute("header", '{"settings": 3}'),
    "header_without_model": attribute("header", '{"settings": {}}'),
    "header_wrong_model": attribute("header", '{"settings": {}, "model": {"gravity": 0, "title": ""}}'),
    "format_later": attribute("format_version", 2),
    "modes_many": replaced("modes", np.zeros(3)),
    "without_places": replaced("places", None),
    "format_other": attribute("format", "something else"),
    "format_number": attribute("format", 3),
}


def results(folder):
    """Write the results files."""
    for name, damage in DAMAGES.items():
        small(folder / f"{name}.h5", damage)
    small(folder / "killed.h5", killed=True)
    for share in (0.02, 0.3, 0.9):
        percent = round(100 * share)
        for killed, word in ((False, "cut"), (True, "killed_and_cut")):
            place = folder / f"{word}_{percent}.h5"
            small(place, killed=killed)
            cut(place, share)


def main():
    """Write all files."""
    FOLDER.mkdir(exist_ok=True)
    for name, text in (*models(), *lines()):
        (FOLDER / f"{name}.toml").write_text(text, encoding="utf-8")
    for name, data in raw():
        (FOLDER / name).write_bytes(data)
    results(FOLDER)


if __name__ == "__main__":
    main()
