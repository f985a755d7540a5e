# SPDX-License-Identifier: MIT
"""The attributes of Result, which are those of what was parsed. The library has the words that help() says of them."""
from . import _shown, _topple

RESULT = {name: of.__doc__ for name, of in vars(_topple.Parsed).items() if isinstance(of, property) and of.__doc__}


def result(kind):
    """Gives the class Result the attributes of what was parsed."""
    def attribute(name, text):
        return property(lambda self: getattr(self._parsed, name), doc=text)

    def named(name, text):
        return property(lambda self: _shown.with_names(getattr(self._parsed, name), self.objects), doc=text)
    for name, text in RESULT.items():
        setattr(kind, name, (named if name in ('supports', 'corrections') else attribute)(name, text))
    return kind
