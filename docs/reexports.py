"""Let the reference show what a package offers with `from ... import name as name`."""

import ast
from typing import Any

import griffe


class Reexports(griffe.Extension):
    """Marks such imports as public, as type checkers do."""

    def on_alias_instance(self, *, alias: griffe.Alias, node: Any, **_: Any) -> None:
        """Called by griffe for every imported name."""
        if isinstance(node, ast.ImportFrom) and any(
            name.name == name.asname == alias.name for name in node.names
        ):
            alias.public = True
