"""pytest plugin of the mutants: kernels as plain Python, or those that the unchanged sources have compiled.

A change of a kernel would have to be compiled, for a minute. The kernels are Python all the same: with
``ANCF_MUTANTS=interpreted`` they run as they stand, on models of a few elements. A change elsewhere leaves
the compiled kernels valid: ``ANCF_MUTANTS=`` followed by their stamp says that the cache may be used.
"""

import os
from typing import Any

from ancf import compiled
from ancf.asked import OF_SENSITIVITIES

_OPERATIONS = {
    "force": "add_force",
    "inertia": "add_inertia",
    "tangent": "add_tangent",
    "energy": "strain_energy",
    "event": "find_event",
    "inverted": "inverted",
    "measure": "measure",
    "remember": "remember",
    **{name: stub.__name__ for name, stub in OF_SENSITIVITIES.items()},
}
_DEFAULTS = {
    "inertia": compiled.no_inertia,
    "energy": compiled.no_energy,
    "event": compiled.no_event,
    "inverted": compiled.never_inverted,
}


#: What :mod:`ancf.batches` does with a plain tuple.
_ALL = {
    "add_forces": "_forces_of_tuple",
    "add_inertias": "_inertias_of_tuple",
    "add_tangents": "_tangents_of_tuple",
    "measure_all": "_measures_of_tuple",
    "remember_all": "_remembered_by_tuple",
    "strain_energies": "_energies_of_tuple",
    "find_events": "_events_of_tuple",
    "last_inverted": "_inverted_of_tuple",
}
#: What :mod:`ancf.solvers.rare` does with all batches, and with one of them.
_RARE = {
    "add_rate_stiffnesses": "rate_stiffness",
    "add_rate_works": "rate_work",
    "add_tangent_works": "tangent_work",
    "add_all_slopes": "work_slopes",
    "add_slopes_along": "force_slopes",
    "add_slopes_beside_all": "slopes_beside",
}
_RARE_OF = {"add_number_work_of": "number_work", "add_changes_of": "changes"}


def _plain(function, finish=None):
    function.py_func = function
    return function


def _interpret() -> None:
    """Replace the decorators and the choice by type; to be done before a kernel gets imported."""
    registered: dict[str, dict[type, Any]] = {name: {} for name in _OPERATIONS}

    def implements(batch_type, **functions):
        compiled.describe(batch_type, **{k: v for k, v in functions.items() if k not in _OPERATIONS})
        for name in _OPERATIONS:
            registered[name][batch_type] = functions.get(name, _DEFAULTS.get(name))

    def chosen(name):
        return lambda batch, *arguments: registered[name][type(batch)](batch, *arguments)

    def optional(function, default=None):
        return lambda items, *arguments: function(items, *arguments) if len(items) else default

    for decorator in ("kernel", "inlined_kernel", "separate_kernel", "inline_kernel", "formula"):
        setattr(compiled, decorator, _plain)
    stubs = {name: chosen(name) for name in _OPERATIONS}
    for name, operation in _OPERATIONS.items():
        setattr(compiled, operation, stubs[name])

    def does_something(batch_type, stub):
        name = next(name for name, own in stubs.items() if own is stub)
        return registered[name].get(batch_type) not in (None, *_DEFAULTS.values())

    compiled.does_something = does_something
    compiled.implements = implements
    from ancf import addresses, batches, choices, records

    choices.optional = optional
    addresses.address_of = lambda function, given, result: function
    addresses.caller = lambda result, given=None, nothing=None: (
        lambda function, arguments: function(*arguments) if function else nothing
    )
    addresses.pointer = records.place = lambda value: value
    records.type_of = type
    records.Located = records.RecordType = lambda value: value
    batches.Batches = type("Batches", (tuple,), {})
    batches.record_at = lambda items, k: items[k]
    for operation, of_tuple in _ALL.items():
        setattr(batches, operation, getattr(batches, of_tuple))
    _interpret_rare(registered, batches.Batches)


def _interpret_rare(registered: dict[str, dict[type, Any]], kind: Any) -> None:
    """The same for operations that only sensitivities ask for."""
    from ancf.solvers import rare

    def of_all(name):
        def done(items, *arguments):
            for batch in items:
                function = registered[name].get(type(batch))
                if function is not None:
                    function(batch, *arguments)

        return done

    def of_one(name):
        return lambda items, k, *arguments: registered[name][type(items[k])](items[k], *arguments)

    rare.knowing = lambda stub, found, *others: kind(found)
    for operation, name in _RARE.items():
        setattr(rare, operation, of_all(name))
    for operation, name in _RARE_OF.items():
        setattr(rare, operation, of_one(name))


_how = os.environ.get("ANCF_MUTANTS", "")
if _how == "interpreted":
    _interpret()
elif _how not in ("", "compile"):
    compiled._STAMP = _how
