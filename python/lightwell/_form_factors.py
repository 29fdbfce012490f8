"""View factors between the faces of a scene."""

from typing import Any, Dict, Iterator, List, Optional

import numpy as np

from . import _lightwell
from ._arrays import checked_progress, set_options
from ._errors import Error, InputError
from ._scene import Progress, Scene, fixed


class FormFactors:
    """View factors F_ij: the share of what leaves row i that arrives at row j directly.

    Rows add up to 1 with `open` and `blocked`, and areas[i] F_ij = areas[j] F_ji, both to the rounding
    of float32. `F, report = form_factors(scene)` unpacks the matrix and the report.
    """

    def __init__(self, found: "_lightwell.FoundFormFactors", target_error: float):
        self.areas: np.ndarray = fixed(found.area)
        """(n,) float64: area of each row, m^2; 0 for a face without area."""
        self.open: np.ndarray = fixed(found.open)
        """(n,) float64: share of each row that leaves the scene or meets a black back."""
        self.blocked: np.ndarray = fixed(found.blocked)
        """(n,) float64: share of each row that meets faces without a row."""
        self.names: List[str] = found.name
        """Name of the surface of each row."""
        self.face: np.ndarray = fixed(found.facet - 1)
        """(n,) int32: face of each row, counted from 0 in the order of the file or the arrays."""
        self.is_back: np.ndarray = fixed(found.is_back.astype(bool))
        """(n,) bool: the row is the back of its face (two_sided)."""
        self.emittance: np.ndarray = fixed(found.emittance)
        """(n,) float64: emittance that a View3D file gives the face, 0 to 1; else 1."""
        self.notes: List[str] = found.notes
        """Findings on the faces, a sentence each."""
        self.error: Optional[float] = found.error
        """Estimated error of the worst factor; None: the method has no estimate."""
        self.target_error: float = target_error
        self.report: Dict[str, Any] = {
            "facets": found.facets,
            "rows": len(self.areas),
            "patches": found.patches,
            "rays": found.rays,
            "closure_max_error": found.closure_max_error,
            "reciprocity_max_error": found.reciprocity_max_error,
            "error_estimate": found.error,
            "target_error": target_error,
            "rays_alone": found.has_rays_alone,
        }
        """Figures by the names that `lightwell form-factors --json` has."""
        self._found = found
        self._arrays = found.csr()
        self._matrix: Any = None

    @property
    def matrix(self) -> Any:
        """scipy.sparse.csr_array, (n, n) float32: F_ij in row i and column j. Needs scipy."""
        if self._matrix is None:
            try:
                from scipy.sparse import csr_array  # type: ignore
            except ImportError:
                raise Error(
                    "the matrix of view factors needs SciPy 1.8, which is not installed: pip install scipy"
                ) from None

            n = len(self.areas)
            self._matrix = csr_array(self._arrays, shape=(n, n))
        return self._matrix

    @property
    def is_short(self) -> bool:
        """True if the estimated error exceeds the target."""
        return self.error is not None and self.error > self.target_error

    def __iter__(self) -> Iterator[Any]:
        return iter((self.matrix, self.report))

    def __repr__(self) -> str:
        error = "no error estimate" if self.error is None else f"error {self.error:.1e}"
        return (
            f"<lightwell.FormFactors: {len(self.areas)} rows, {len(self._arrays[0])} entries, {error},"
            f" closure within {self.report['closure_max_error']:.1e}>"
        )


def form_factors(
    scene: Scene,
    *,
    method: str = "auto",
    target_error: float = 1e-3,
    max_patch_size: Optional[float] = None,
    hemicube_resolution: Optional[int] = None,
    two_sided: bool = False,
    memory: Optional[float] = None,
    progress: Optional[Progress] = None,
) -> FormFactors:
    """View factors between the faces of a scene; materials do not matter.

    method: "auto", "ray-cast", "hemicube" or "analytic".
    target_error: wanted standard error of every factor, > 0.
    max_patch_size: metres; rows are patches of at most this edge instead of faces.
    hemicube_resolution: cells along an edge of the hemicube's top, even, 2 to 4096 (256).
    two_sided: both sides have rows; row n + i is the back of row i of n.
    memory: most bytes of the process; rows beyond it go to a file in the working folder.
    progress: called with the phase and the share done; False stops the work.

    Rows are the faces of `Scene.from_arrays`, or the polygons of the scene's file, which is read
    again, in its order. The numbers are those of `lightwell form-factors`, bit for bit.

    Raises InputError, and Interrupted after False.
    """
    if not isinstance(scene, Scene):
        raise InputError(f"scene is {scene!r}; give a lightwell.Scene")
    options = _lightwell.FormFactorOptions()
    set_options(
        options,
        {
            "method": method,
            "target_error": target_error,
            "max_patch_size": max_patch_size,
            "hemicube_resolution": hemicube_resolution,
            "two_sided": two_sided,
            "memory": memory,
        },
    )
    found = _lightwell.form_factors(scene._data, options, checked_progress(progress))
    return FormFactors(found, float(target_error))
