"""The one error a user sees: a single line saying what is wrong and where."""


class UserError(Exception):
    """Something in the user's input or request is wrong; the message is one line.

    Raised by every room; the command line prints it as ``avd: <message>`` and exits 1.
    The message names the file (where there is one), the index and the reason.
    """

    def __init__(self, message: str) -> None:
        """Fold ``message`` to one line."""
        super().__init__(" ".join(message.split()))
