"""Write the reference of the command line from the commands themselves."""

from typing import Any

import typer
from typer.cli import get_docs_for_click

from handeye.cli import app


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Add every command with its options to the page of the command line."""
    if page.file.src_uri != "reference/cli.md":
        return markdown
    command = typer.main.get_command(app)
    context: Any = typer.Context(command, info_name="handeye")
    with context:
        written = get_docs_for_click(obj=command, ctx=context, name="handeye", indent=1)
    # Rich markup is for terminals.
    for mark in ("[bold]", "[/]"):
        written = written.replace(mark, "")
    return f"{markdown}\n{written}"
