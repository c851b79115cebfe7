"""The two errors that reach a user: where it happened, what is wrong, what to do."""

from __future__ import annotations


class ModelError(ValueError):
    """The description of the model is wrong; nothing was computed.

    Parameters
    ----------
    where : str
        Place in the model, in the notation of the model file: ``bodies[2].section.EA``,
        or the call and the name: ``add_beam("beam").elements``.
    what : str
        What is wrong, with the offending value.
    hint : str, optional
        What to do about it.
    """

    def __init__(self, where: str, what: str, hint: str = "") -> None:
        self.where, self.what, self.hint = where, what, hint
        super().__init__(_sentence(where, what, hint))


class SolveError(RuntimeError):
    """A solve stopped; what was computed until then is kept.

    Parameters
    ----------
    where : str
        Time, step and coordinate: ``t = 0.1234 s, step 1234, beam node 3 z``.
    what : str
        What happened.
    hint : str, optional
        The likely cause and what to try.
    """

    def __init__(self, where: str, what: str, hint: str = "") -> None:
        self.where, self.what, self.hint = where, what, hint
        super().__init__(_sentence(where, what, hint))


def _sentence(where: str, what: str, hint: str) -> str:
    return f"{where}: {what}" + (f" ({hint})" if hint else "")
