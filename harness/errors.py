"""The one error a user sees: a single line saying what is wrong and where."""

from __future__ import annotations

from collections.abc import Iterable


class UserError(Exception):
    """Something in the user's input or request is wrong; the message is one line.

    Raised by every room; the command line prints it as ``avd: <message>`` and exits 1.
    The message names the file (where there is one), the index and the reason.
    """

    def __init__(self, message: str) -> None:
        """Fold ``message`` to one line."""
        super().__init__(" ".join(message.split()))


def suggestion(given: str, known: Iterable[str]) -> str:
    """The known word that was probably meant, as a question; empty if none is close."""
    import difflib

    close = difflib.get_close_matches(given, list(known), n=1, cutoff=0.5)
    return f"did you mean {close[0]!r}?" if close else ""


def shown(value: object) -> str:
    """A wrong value as an error quotes it: on one line, and cut where it is long."""
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # a number of too many digits
        return "a very long number"
    return text if len(text) <= 60 else text[:59] + "…"
