"""The figure of benchmarks/online.py: held-out error against updates per second."""

from pathlib import Path

from matplotlib.figure import Figure

# Colour says whose it is, and a letter which.
FAMILIES = {
    "recursive": ("#00796b", "o"),
    "Kalman": ("#c2185b", "P"),
    "1993": ("#e65100", "s"),
    "Fourier": ("#3949ab", "^"),
    "LoG-GP": ("#8e24aa", "D"),
    "scikit-learn": ("#757575", "v"),
    "river": ("#757575", "<"),
    "xcsf": ("#757575", ">"),
}


def draw(values: dict[tuple[str, str], tuple[float, float]], path: Path) -> None:
    """Write medians {(contestant, stream): (error, updates per second)} as a picture."""
    names = list(dict.fromkeys(key[0] for key in values))
    streams = list(dict.fromkeys(key[1] for key in values))
    columns = 3
    rows = -(-(len(streams) + 1) // columns)
    figure = Figure(figsize=(10.5, 3.6 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for one, stream in zip(axes, streams, strict=False):
        one.set(xscale="log", yscale="log", title=stream)
        one.set(xlabel="updates per second", ylabel="held-out error / variance")
        one.axvline(10_000, color="#bdbdbd", linewidth=1, zorder=0)
        one.grid(visible=True, color="#eeeeee", zorder=0)
        for letter, name in zip("abcdefghijklmnopqrstuvwxyz", names, strict=False):
            if (name, stream) not in values:
                continue
            error, rate = values[name, stream]
            colour, marker = _style(name)
            one.plot(
                rate, error, marker, color=colour, markersize=11, alpha=0.35, markeredgewidth=0
            )
            one.annotate(letter, (rate, error), ha="center", va="center", fontsize=8)
    for one in axes[len(streams) :]:
        one.axis("off")
    key = axes[len(streams)]
    for i, (letter, name) in enumerate(zip("abcdefghijklmnopqrstuvwxyz", names, strict=False)):
        y = 1.0 - (i + 0.5) / len(names)
        colour, marker = _style(name)
        key.plot(0.03, y, marker, color=colour, markersize=11, alpha=0.35, markeredgewidth=0)
        key.annotate(letter, (0.03, y), ha="center", va="center", fontsize=8)
        key.annotate(name, (0.09, y), va="center", fontsize=9)
    key.set(xlim=(0, 1), ylim=(0, 1))
    figure.savefig(path, dpi=110)


def _style(name: str) -> tuple[str, str]:
    return next(style for start, style in FAMILIES.items() if name.startswith(start))
