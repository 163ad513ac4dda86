"""What every test shares: kernel cache, Hypothesis profiles, real data, a browser."""

import hashlib
import os
import shutil
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from hypothesis import HealthCheck, settings
from playwright.sync_api import Browser, ConsoleMessage, Page, Route, sync_playwright

REPOSITORY = Path(__file__).resolve().parents[1]


def _kernel_cache() -> Path:
    """A folder named after the text of every package that has kernels.

    Numba looks only at the file of the cached function itself, so it would go on using a kernel
    after a function or a NamedTuple of another file that is compiled into it has changed.
    """
    package = REPOSITORY / "src" / "handeye"
    files = {package / "_compiled.py"}
    for path in package.rglob("*.py"):
        if b"handeye._compiled" in path.read_bytes():
            files.update(path.parent.glob("*.py"))
    digest = hashlib.sha256()
    for path in sorted(files):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    checked = "-boundscheck" if os.environ.get("NUMBA_BOUNDSCHECK", "0") == "1" else ""
    return REPOSITORY / ".cache" / "numba" / (digest.hexdigest()[:16] + checked)


# Tests run side by side: each with the linear algebra of one core.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# Read by scipy when it is first imported: scikit-learn's check of array types skips without it.
os.environ["SCIPY_ARRAY_API"] = "1"

# Read by numba when it is first imported, here and in the processes that tests start.
os.environ["NUMBA_CACHE_DIR"] = str(_kernel_cache())

# "ci" draws the same examples every time. Deadlines and slow generation are not judged: a first
# call compiles, and the suite also runs with compilation off.
settings.register_profile(
    "ci",
    derandomize=True,
    deadline=None,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("ci")


@pytest.fixture(scope="session")
def repository() -> Path:
    """The root of the checkout."""
    return REPOSITORY


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of real measurements, which is not part of the repository."""
    folder = Path(os.environ.get("HANDEYE_SHARED", REPOSITORY.parent / "shared")) / "data"
    if not folder.is_dir():
        pytest.skip("the folder of real measurements is absent (set HANDEYE_SHARED to its parent)")
    return folder


@dataclass
class WatchedPage:
    """A browser page together with everything that went wrong in it."""

    page: Page
    console_errors: list[str] = field(default_factory=list)
    page_errors: list[str] = field(default_factory=list)
    outside_requests: list[str] = field(default_factory=list)

    @property
    def problems(self) -> list[str]:
        """Empty for a page that works, and works offline."""
        return self.console_errors + self.page_errors + self.outside_requests


def _leaves_the_machine(url: str) -> bool:
    parts = urlsplit(url)
    loopback = {"localhost", "127.0.0.1", "::1"}
    return parts.scheme not in {"file", "data", "about", "blob"} and parts.hostname not in loopback


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """The system's Chromium, headless."""
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
    found = next((path for name in names if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip("no Chromium on this machine")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(
            executable_path=found,
            args=[
                "--no-sandbox",
                "--disable-gpu",
                "--disable-quic",
                "--no-first-run",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-sync",
            ],
        )
        yield started
        started.close()


@pytest.fixture
def watched_page(browser: Browser) -> Iterator[WatchedPage]:
    """A fresh page; requests that would leave the machine are noted and refused."""
    context = browser.new_context(viewport={"width": 1200, "height": 900})
    watched = WatchedPage(context.new_page())

    def gate(route: Route) -> None:
        if _leaves_the_machine(route.request.url):
            watched.outside_requests.append(route.request.url)
            route.abort()
        else:
            route.continue_()

    def on_console(message: ConsoleMessage) -> None:
        if message.type == "error":
            watched.console_errors.append(message.text)

    context.route("**/*", gate)
    watched.page.on("console", on_console)
    watched.page.on("pageerror", lambda error: watched.page_errors.append(str(error)))
    yield watched
    context.close()
