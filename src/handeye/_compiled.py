"""The one place that knows Numba."""

from collections.abc import Callable
from typing import Any, ParamSpec, Protocol, TypeVar, cast

import numba
from numba.core import types
from numba.extending import overload

P = ParamSpec("P")
R = TypeVar("R")
R_co = TypeVar("R_co", covariant=True)

# Reordered sums fill the vector units; infinities and NaN still follow IEEE rules.
_REORDER = {"reassoc", "contract", "nsz"}

_kernels: list[Any] = []


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a dumb loop (arrays in, arrays out); division follows IEEE rules, it never raises."""
    return cast("Callable[P, R]", _njit(function, fastmath={"contract"}))


def compiled_sums(function: Callable[P, R]) -> Callable[P, R]:
    """The same, and sums may be taken in any order.

    Results agree with the written order to rounding.
    """
    return cast("Callable[P, R]", _njit(function, fastmath=_REORDER))


def _njit(function: Callable[..., Any], fastmath: set[str]) -> Any:
    decorate = cast("Any", numba.njit(cache=True, error_model="numpy", fastmath=fastmath))
    kernel = decorate(function)
    _kernels.append(kernel)
    return kernel


def _stop_caching() -> None:
    """Compile anew in this process from now on.

    Numba looks for changes only in the file of the kernel itself, so it would go on using a kernel
    into which an older text of somebody's own kind was compiled.
    """
    for kernel in _kernels:
        if hasattr(kernel, "_cache"):  # not with compilation off
            kernel._cache.disable()


class KindFunction(Protocol[P, R_co]):
    """A function with one implementation for each type of its first argument."""

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R_co: ...

    def of(self, kind: type) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        """Decorate the implementation for `kind`, a NamedTuple class; argument names must match."""
        ...


def by_kind(declaration: Callable[P, R]) -> KindFunction[P, R]:
    """Let compiled code choose an implementation by the type of the first argument.

    The declaration gives name, arguments and docstring; its body is never run. Each kind is
    compiled into its caller, so choosing costs nothing at run time. Kernels are cached on disk as
    long as every kind in the process is one of this package.

    Example:
        @by_kind
        def area(shape): ...

        @area.of(Square)
        def square_area(shape):
            return shape.side**2
    """
    implementations: dict[type, Callable[..., Any]] = {}

    def dispatch(kind: Any, *rest: Any) -> Any:
        return implementations[type(kind)](kind, *rest)

    def choose(kind: Any, *_: Any) -> Callable[..., Any] | None:
        if isinstance(kind, types.BaseNamedTuple):
            return implementations.get(cast("Any", kind).instance_class)
        return None

    def of(kind: type) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        def register(implementation: Callable[..., Any]) -> Callable[..., Any]:
            implementations[kind] = implementation
            if kind.__module__.partition(".")[0] != __name__.partition(".")[0]:
                _stop_caching()
            return implementation

        return register

    register_overload = cast(
        "Any", overload(dispatch, strict=False, jit_options={"error_model": "numpy"})
    )
    register_overload(choose)
    dispatch.__name__ = declaration.__name__
    dispatch.__doc__ = declaration.__doc__
    cast("Any", dispatch).of = of
    return cast("KindFunction[P, R]", dispatch)
