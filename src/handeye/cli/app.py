"""All commands of `handeye`."""

from typing import Annotated

import typer

import handeye
from handeye.cli.apply import apply
from handeye.cli.calibrate import calibrate
from handeye.cli.catch import catch
from handeye.cli.console import ErrorsForPeople
from handeye.cli.convert import convert
from handeye.cli.demo import demo
from handeye.cli.export import export
from handeye.cli.hand_eye import solve
from handeye.cli.reproduce import reproduce
from handeye.cli.simulate import simulate
from handeye.cli.suggest import suggest

app = typer.Typer(
    name="handeye",
    cls=ErrorsForPeople,
    help="A robot that sees and reaches learns, while it works, where its hand really goes.",
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_show_locals=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"handeye {handeye.__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="Print the version and exit."
        ),
    ] = False,
) -> None:
    """A robot that sees and reaches learns, while it works, where its hand really goes."""


_WATCH, _OWN, _RESEARCH = "Watch it learn", "Your robot", "The thesis"
app.command(rich_help_panel=_WATCH)(demo)
app.command(rich_help_panel=_WATCH)(catch)
app.command(rich_help_panel=_WATCH)(simulate)
app.command(rich_help_panel=_OWN)(calibrate)
app.command(rich_help_panel=_OWN)(apply)
app.command("hand-eye", rich_help_panel=_OWN)(solve)
app.command(rich_help_panel=_OWN)(suggest)
app.command(rich_help_panel=_OWN)(convert)
app.command(rich_help_panel=_OWN)(export)
app.command(rich_help_panel=_RESEARCH)(reproduce)


def main() -> None:
    """Entry point of the `handeye` command."""
    app()
