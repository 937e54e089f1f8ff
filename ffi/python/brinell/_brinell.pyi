from os import PathLike
from typing import Any, Callable, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
_Table = dict[str, Any]
_Callback = Optional[Callable[[dict[str, Any]], Any]]

def run(
    scene: str,
    is_path: bool,
    overrides: Sequence[str],
    solver: Optional[str],
    callback: _Callback,
    estimate: bool,
    threads: Optional[int],
    budget: Optional[float],
) -> Result: ...

class State:
    name: str
    def __getattr__(self, quantity: str) -> float: ...
    contact_arc: Optional[list[float]]
    pairs: _Table
    patches: list[dict[str, Any]]
    fields: Optional[dict[str, NDArray[Any]]]
    quality: dict[str, float]

class Result:
    first_yield: Optional[dict[str, Any]]
    states: _Table
    history: _Table
    mesh: _Table
    summary: dict[str, Any]
    quality: dict[str, float]
    warnings: list[str]
    incomplete: Optional[str]
    inaccurate: list[str]
    def write(self, directory: Union[str, PathLike[str]]) -> None: ...
    def __len__(self) -> int: ...
    def __getitem__(self, which: Union[int, str]) -> State: ...

class Model:
    n_nodes: int
    n_elements: int
    def __init__(self, kind: str = "plane_strain", *, symmetry: int = 1, title: str = "") -> None: ...
    def nodes(self, coordinates: ArrayLike) -> None: ...
    def elements(self, body: str, nodes: ArrayLike, *, shape: str = "quad4") -> None: ...
    def node_set(self, name: str, nodes: ArrayLike) -> None: ...
    def surface(self, name: str, facets: ArrayLike) -> None: ...
    def surface_of_nodes(self, name: str, nodes: ArrayLike) -> None: ...
    def circle(self, surface: str, center: Sequence[float], radius: float, *, outward: bool = True) -> None: ...
    def tables(self, text: str) -> None: ...
    def material(self, name: str, **values: Any) -> None: ...
    def body(self, name: str, material: str, *, plastic: Optional[bool] = None) -> None: ...
    def contact(
        self,
        first: str,
        second: str,
        *,
        pairs: Optional[ArrayLike] = None,
        gap: Optional[ArrayLike] = None,
        normal: Optional[ArrayLike] = None,
        interference: float = 0.0,
        slave: str = "auto",
    ) -> None: ...
    def support(self, on: str, fix: str, *, angle: Optional[float] = None) -> None: ...
    def load(self, on: str, **values: Any) -> None: ...
    def nodal_load(self, name: str, nodes: ArrayLike, forces: ArrayLike, *, history: Any = None) -> None: ...
    def target(self, *, first_yield: bool = False, **values: Any) -> None: ...
    def program(self, **values: Any) -> None: ...
    def settings(self, **values: Any) -> None: ...
    def run(self, *, solver: Optional[str] = None, callback: _Callback = None, threads: Optional[int] = None) -> Result: ...

class Structure:
    n_freedoms: int
    n_rows: int
    contact_freedoms: NDArray[np.int64]
    condensed_stiffness: NDArray[np.float64]
    gaps: NDArray[np.float64]
    forces: NDArray[np.float64]
    closed: NDArray[np.bool_]
    backward_error: float
    def __init__(
        self,
        stiffness: Any,
        rows: Any = None,
        gaps: Optional[ArrayLike] = None,
        *,
        triangle: str = "both",
        solver: Optional[str] = None,
    ) -> None: ...
    def solve(self, load: ArrayLike) -> None: ...
    def start(self, rate: ArrayLike) -> None: ...
    def step(self, end: float) -> tuple[float, list[tuple[int, bool]]]: ...
    def displacements(self, out: Optional[NDArray[np.float64]] = None) -> NDArray[np.float64]: ...
