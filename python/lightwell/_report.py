"""Lighting reports of solutions."""

import json
import os
from typing import Any, Dict, List, Mapping

from . import _lightwell
from ._arrays import at_least_zero, real_number, set_options
from ._errors import InputError


def report_figures(
    solution: "_lightwell.SolutionData", files: List[str], asked: Mapping[str, Any], progress: Any
) -> Dict[str, Any]:
    """The figures of the arguments of `Solution.report` by name; also written to files."""
    for file in files:
        if os.path.splitext(file)[1] not in (".html", ".pdf", ".json", ".csv"):
            raise InputError(f"'{file}' must end in .html, .pdf, .json or .csv")
    request = _request(asked)
    request.has_picture = any(file.endswith((".html", ".pdf")) for file in files)
    figures: Dict[str, Any] = json.loads(
        _lightwell.report(solution, request, files, str(asked["language"]), progress)
    )
    return figures


def _request(asked: Mapping[str, Any]) -> "_lightwell.ReportRequest":
    request = _lightwell.ReportRequest()
    request.surfaces = [str(name) for name in asked["surfaces"]]
    request.observers = [str(name) for name in asked["observers"]]
    for name, height in asked["planes"].items():
        request.add_plane(str(name), at_least_zero(f"the height above {name}", height))
    for name, power in asked["watts"].items():
        request.add_watts(str(name), real_number(f"the power of {name}", power))
    margin, maintenance = asked["margin"], asked["maintenance"]
    request.margin = None if margin is None else at_least_zero("margin", margin)
    if maintenance is not None:
        request.maintenance = real_number("maintenance", maintenance)
        if not 0.0 < request.maintenance <= 1.0:
            raise InputError(f"maintenance is {maintenance}; a factor above 0 up to 1 is needed")
    request.activity = str(asked["activity"])
    tables = ("areas", "activities", "sports", "colour_samples")
    set_options(request, {name: None if asked[name] is None else os.fspath(asked[name]) for name in tables})
    request.camera = "" if asked["camera"] is None else str(asked["camera"])
    set_options(request, {"spacing": asked["spacing"], "rays": asked["rays"]})
    return request
