"""Irregular lines: droppers that are cut or measured inexactly, and heights with a spectrum."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from ..lines.fittings import DropperErrors
from ..lines.line import Line
from .form import Form

#: Waves of which random heights consist.
WAVES = 400
MOST_SEED = 2**32


def dropper_errors(found: Form, deviation: float, seed: int) -> Line:
    """The line of a form with droppers whose lengths are off by normally distributed errors.

    Parameters
    ----------
    found : Form
        Of the design; its natural lengths are what was ordered.
    deviation : float, m
        Standard deviation of each length.
    seed : int
        The same gives the same line.

    Returns
    -------
    Line
        With ``dropper_lengths``; its form is the line as built.

    Raises
    ------
    ModelError
        A number is wrong, or an error is as long as its dropper.

    """
    if not hasattr(found, "cut_length") or hasattr(found, "forms"):
        what = f"must be the Form of one tension length, is {checks.shown(found)}"
        raise ModelError("dropper_errors.found", what, "ancf.catenary.form finds it, a route has form.forms")
    errors = DropperErrors(deviation=deviation, seed=seed)
    errors.check("dropper_errors")
    return replace(found.line, dropper_lengths=tuple(with_errors(found, errors).tolist()))


def with_errors(found: Form, errors: DropperErrors, section: int = 0) -> FloatArray:
    """Natural lengths (n,) in m with errors; each tension length of a route, from 0, has its own.

    They are those of ``dropper_lengths`` where the line has some, and of the design otherwise.
    """
    given = found.line.dropper_lengths
    plain = found.cut_length if given is None else np.array(given)
    section = errors.section or section
    random = np.random.default_rng(errors.seed if section == 0 else [errors.seed, section])
    off = random.standard_normal(errors.before + plain.size)[errors.before :]
    lengths: FloatArray = plain + errors.deviation * off
    if np.any(lengths <= 0.0):
        worst = int(np.argmin(lengths))
        what = f"is {errors.deviation:g} m, which leaves nothing of {found.line.dropper_label(worst)}"
        raise ModelError("dropper_errors.deviation", what, "units are m")
    return lengths


def height_errors(
    line: Line,
    spectrum: Callable[[FloatArray], FloatArray],
    wavelengths: tuple[float, float],
    seed: int,
) -> Line:
    """The line with random heights of its contact wire at the droppers, beside the pre-sag.

    Parameters
    ----------
    line : Line
    spectrum : callable
        One-sided power spectral density of the height in m^2/(1/m), of spatial frequencies (n,) in 1/m; its
        integral over the band is the mean square.
    wavelengths : (float, float), m
        Shortest and longest waves; droppers resolve none shorter than twice their distance.
    seed : int
        The same gives the same line.

    Raises
    ------
    ModelError
        A number is wrong, or the spectrum has values that are no finite numbers >= 0.

    """
    if not hasattr(line, "dropper_x") or not hasattr(line, "contact_wires"):
        what = f"must be a Line, is {checks.shown(line)}"
        raise ModelError("height_errors.line", what, "ancf.catenary.read_line reads one")
    places = line.dropper_x[:: line.contact_wires]
    error = random_waves(spectrum, wavelengths, seed, places, "height_errors")
    first = 0
    spans = []
    for span in line.spans:
        own = error[first : first + len(span.droppers)]
        spans.append(replace(span, pre_sag=tuple((np.array(span.pre_sag) - own).tolist())))
        first += len(span.droppers)
    return replace(line, spans=tuple(spans))


def random_waves(
    spectrum: Callable[[FloatArray], FloatArray],
    wavelengths: tuple[float, float],
    seed: int,
    places: FloatArray,
    where: str,
) -> FloatArray:
    """A random process of space with a one-sided spectral density in m^2/(1/m), at places (n,) in m.

    Raises
    ------
    ModelError
        A number is wrong, or the spectrum has values that are no finite numbers >= 0.

    """
    shortest, longest = checks.array(wavelengths, f"{where}.wavelengths", (2,)).tolist()
    if not 0.0 < shortest < longest:
        what = f"are {shortest:g} to {longest:g} m, must be 0 < shortest < longest"
        raise ModelError(f"{where}.wavelengths", what)
    checks.function(spectrum, f"{where}.spectrum", "spatial frequencies (n,) in 1/m")
    random = np.random.default_rng(checks.integer(seed, f"{where}.seed", 0, MOST_SEED))
    edges = np.linspace(1.0 / longest, 1.0 / shortest, WAVES + 1)
    frequency = 0.5 * (edges[1:] + edges[:-1])
    density = np.asarray(spectrum(frequency), dtype=np.float64)
    if density.shape != frequency.shape or not np.all(np.isfinite(density)) or np.any(density < 0.0):
        raise ModelError(f"{where}.spectrum", "must give a finite number >= 0 for each frequency")
    amplitude = np.sqrt(2.0 * density * np.diff(edges))
    phase = random.uniform(0.0, 2.0 * math.pi, WAVES)
    waves: FloatArray = np.cos(2.0 * math.pi * np.outer(places, frequency) + phase) @ amplitude
    return waves
