"""Kinds: NamedTuple classes that choose a formula, checked and stored by their names."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from handeye.arrays import scalar
from handeye.errors import FileFormatError, InvalidInput

Known = Mapping[str, type]
"""The registered classes of one role by name."""


def checked_kind(
    role: str, kind: NamedTuple, known: Known, *, above: float | None = None
) -> NamedTuple:
    """`kind` with plain numbers in its fields.

    Raises InvalidInput unless it is an instance of a registered class of that role and its fields
    are finite numbers, greater than `above`.
    """
    if known.get(type(kind).__name__) is not type(kind):
        hint = f" (an instance, {kind.__name__}(), not the class)" if isinstance(kind, type) else ""
        raise InvalidInput(
            f"{role} must be one of {', '.join(sorted(known))}{hint}, got {kind!r}; "
            "docs/how-to/extend-networks.md shows how to add a kind"
        )
    fields = kind._asdict().items()
    numbers = {name: scalar(value, f"{role} {name}", above=above) for name, value in fields}
    # 1 for 1.0 would compile everything once more; but a kind may count with a whole number.
    counts = {k for k, v in type(kind).__annotations__.items() if v in {int, "int"}}
    return kind._replace(**{k: int(v) if k in counts else v for k, v in numbers.items()})


def stored_kind(kind: NamedTuple) -> dict[str, Any]:
    """A kind as JSON can hold it."""
    return {"kind": type(kind).__name__, **kind._asdict()}


def restored_kind(role: str, stored: dict[str, Any], known: Known) -> Any:
    """The kind of `stored_kind`.

    Raises FileFormatError if it is not registered, or what Python raises where fields do not fit.
    """
    fields = dict(stored)
    name = fields.pop("kind")
    if name not in known:
        raise FileFormatError(
            f"it uses the {role} {name!r}, which is not registered: import the module that "
            f"defines it before loading (known: {', '.join(sorted(known))})"
        )
    return known[name](**fields)
