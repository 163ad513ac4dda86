"""A YAML file whose every entry knows its line, so that errors can name it."""

from collections.abc import Collection, Generator, Iterable
from contextlib import contextmanager
from dataclasses import dataclass
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any, Self, cast

from handeye.arrays import Array, finite, scalar
from handeye.errors import FileFormatError, InvalidInput, MissingExtra


class _Placed(InvalidInput):
    """Names its place already."""


@dataclass(frozen=True)
class Entry:
    """A value of a YAML file: a text, a number, a list or a table of entries.

    file, line  where it stands, lines counted from 1
    name        keys that lead to it, "measurements 2: std"
    value       a str, int, float, bool or None, a list of entries, or a dict of them
    """

    file: str
    line: int
    name: str
    value: Any

    def error(self, problem: str) -> InvalidInput:
        """What is wrong with the entry, with its place."""
        where = f"{self.file}, line {self.line}"
        return _Placed(f"{where}, {self.name}: {problem}" if self.name else f"{where}: {problem}")

    @contextmanager
    def blamed(self) -> Generator[None]:
        """Errors of input inside name this entry."""
        try:
            yield
        except _Placed:
            raise
        except InvalidInput as error:
            raise self.error(str(error)) from error

    def table(self, keys: Collection[str], needed: Iterable[str] = ()) -> dict[str, Self]:
        """The entries of a table by key; InvalidInput for unknown and for missing keys."""
        found = self.tables()
        for key, entry in found.items():
            if key not in keys:
                near = get_close_matches(key, keys, n=1)
                meant = f"did you mean {near[0]}? " if near else ""
                raise entry.error(f"is not known here: {meant}choose from {', '.join(keys)}")
        missing = [key for key in needed if key not in found]
        if missing:
            raise self.error(f"needs {', '.join(missing)}")
        return found

    def tables(self) -> dict[str, Self]:
        """The entries of a table whose keys are names that the user chose."""
        if not _is_a(self.value, dict):
            raise self.error(f"must be a table of `key: value` lines, got {self._shown()}")
        return cast("dict[str, Self]", self.value)

    def items(self) -> list[Self]:
        """The entries of a list."""
        if not _is_a(self.value, list):
            raise self.error(f"must be a list, got {self._shown()}")
        return cast("list[Self]", self.value)

    def text(self, choices: Collection[str] = ()) -> str:
        """A text, one of `choices` if there are any."""
        if not isinstance(self.value, str):
            raise self.error(f"must be a text, got {self._shown()}")
        if choices and self.value not in choices:
            near = get_close_matches(self.value, choices, n=1)
            meant = f"did you mean {near[0]}? " if near else ""
            raise self.error(
                f"{self.value!r} is not known: {meant}choose from {', '.join(choices)}"
            )
        return self.value

    def number(self, *, above: float | None = None, least: float | None = None) -> float:
        """A number; 1e-4 counts as one, although YAML 1.1 takes it for a text."""
        value = self._number(self.value)
        with self.blamed():
            return scalar(value, "the number", above=above, least=least)

    def whole(self) -> int:
        """A whole number."""
        if not isinstance(self.value, int) or isinstance(self.value, bool):
            raise self.error(f"must be a whole number, got {self._shown()}")
        return self.value

    def numbers(self) -> Array:
        """A number (), a list of numbers (n,), or a list of lists (m, n)."""
        with self.blamed():
            return finite(self._nested(), "the numbers")

    def _nested(self) -> Any:
        if _is_a(self.value, list):
            return [entry._nested() for entry in self.items()]
        return self._number(self.value)

    def _number(self, value: Any) -> float:
        try:
            if not isinstance(value, int | float | str) or isinstance(value, bool):
                raise ValueError
            return float(value)
        except ValueError:
            raise self.error(f"must be a number, got {self._shown()}") from None

    def _shown(self) -> str:
        kind: dict[type[object], str] = {dict: "a table", list: "a list", type(None): "nothing"}
        return next((said for t, said in kind.items() if _is_a(self.value, t)), repr(self.value))


def read_yaml(path: Path) -> Entry:
    """The whole of a YAML file.

    Raises:
        InvalidInput: there is no such file, or a key comes twice.
        FileFormatError: it is not YAML.
        MissingExtra: without PyYAML.
    """
    try:
        yaml: Any = import_module("yaml")
    except ImportError as error:
        raise MissingExtra("A description in YAML", "yaml") from error
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidInput(f"{path}: cannot be read ({error}): check the path") from error
    loader = yaml.SafeLoader(text)
    try:
        node = loader.get_single_node()
        if node is None:
            raise InvalidInput(f"{path}: is empty")
        return _entry(yaml, loader, node, str(path), "")
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f", line {mark.line + 1}" if mark else ""
        problem = getattr(error, "problem", None) or error
        raise FileFormatError(
            f"{path}{where}: is not YAML ({problem}): check indentation, colons and quotes there"
        ) from error
    finally:
        loader.dispose()


def _is_a(value: object, kind: type[object]) -> bool:
    """isinstance, which leaves the checker's knowledge of `Any` alone."""
    return isinstance(value, kind)


def _entry(yaml: Any, loader: Any, node: Any, file: str, name: str) -> Entry:
    line = int(node.start_mark.line) + 1
    if isinstance(node, yaml.MappingNode):
        table: dict[str, Entry] = {}
        for key_node, value_node in node.value:
            key = str(loader.construct_object(key_node))
            own = _entry(yaml, loader, value_node, file, f"{name}: {key}" if name else key)
            own = Entry(file, int(key_node.start_mark.line) + 1, own.name, own.value)
            if key in table:
                raise own.error(f"comes twice, first in line {table[key].line}: delete one")
            table[key] = own
        return Entry(file, line, name, table)
    if isinstance(node, yaml.SequenceNode):
        parts = [
            _entry(yaml, loader, part, file, f"{name} {i + 1}") for i, part in enumerate(node.value)
        ]
        return Entry(file, line, name, parts)
    return Entry(file, line, name, loader.construct_object(node))
