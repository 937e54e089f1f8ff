"""What can go wrong."""


class Error(Exception):
    """A failure of brinell.

    kind: a word ("input", "unheld", "collapse", ...); status: the exit code of the program for it; result: what was computed before
    the failure, or None.
    """

    def __init__(self, message, kind="internal", status=70, result=None):
        super().__init__(message)
        self.kind = kind
        self.status = status
        self.result = result

    def __str__(self):
        # A KeyError would put its text in quotes.
        return Exception.__str__(self)


class InputError(Error, ValueError):
    """An argument, the scene or the mesh is wrong."""


class MissingError(InputError, KeyError):
    """A state is asked for that the result does not have."""


class UnsupportedError(InputError):
    """The scene asks for an effect that brinell does not have."""


class IoError(Error, OSError):
    """A file cannot be read or written."""


class UnheldError(Error):
    """The model is not held: a body can move freely."""


class AnalysisError(Error):
    """A solve did not converge, or a target was not reached."""


class CollapseError(AnalysisError):
    """The load passed the limit load."""


class OutgrownError(AnalysisError):
    """Contact reached the end of its candidates although the bodies go on there."""


class InternalError(Error):
    """A fault of brinell itself."""


class InaccurateWarning(UserWarning):
    """A state's quality misses its tolerance or a contact carries a force though a load takes its surfaces apart (the
    result is not to be trusted), or a demanded accuracy was not reached."""


_KINDS = {
    "input": InputError,
    "missing": MissingError,
    "unsupported": UnsupportedError,
    "io": IoError,
    "unheld": UnheldError,
    "analysis": AnalysisError,
    "collapse": CollapseError,
    "outgrown": OutgrownError,
    "internal": InternalError,
}


def make(kind, status, message, result):
    of = _KINDS.get(kind, Error)
    return of(message, "input" if of is MissingError else kind, status, result)
