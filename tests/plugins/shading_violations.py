"""Which invariants of light some published methods break, and why; anything else must pass.

Each row: the test, the model, parts of its parameters' names of which one must be there, the
reason. A row that no longer fails is reported. By how much and where each method breaks what:
`test_shading_violations`.
"""

from _pytest.mark import ParameterSet
from pytest import mark, param

LAMBERT = "test_a_large_radius_is_lambert"
ENERGY = "test_no_more_light_leaves_a_sphere_than_falls_on_it"
MONOTONE = "test_a_higher_light_never_darkens_a_strongly_curved_surface"

_FIRST_ORDER = (
    "eq. 11 of Kolchin 2007 is the first order in curvature: its glow, R_d l_u psi(0)/radius at the"
    " terminator, has no bound"
)
_NO_GLOW_FACING = (
    "the glow of eq. 11 of Kolchin 2007 goes as |S+ w_t|, which is 0 where the light stands highest"
)
_RING = "a blur around a ring, as section 1.4 of Penner and Borshukov 2011 has it, keeps no area"

VIOLATIONS: list[tuple[str, str, tuple[str, ...], str]] = [
    (LAMBERT, "wrap", ("",), "Green 2004 wraps flat surfaces too"),
    (LAMBERT, "bredow2002", ("",), "falls off evenly with the angle on flat surfaces too"),
    (LAMBERT, "curvature-lut-physical", ("",), "a flat surface's albedo depends on the angle"),
    (ENERGY, "kolchin2007", ("",), _FIRST_ORDER),
    (ENERGY, "kolchin2007-simplified", ("",), _FIRST_ORDER),
    (ENERGY, "kubo2010", ("spectralon",), _RING),
    (ENERGY, "penner2011", ("spectralon",), _RING),
    (ENERGY, "wrap", ("spectralon",), "section 16.2 of Green 2004 has no normalisation"),
    (MONOTONE, "kolchin2007", ("0.1", "0.5"), _NO_GLOW_FACING),
    (MONOTONE, "kolchin2007-simplified", ("0.1", "0.5"), _NO_GLOW_FACING),
    (MONOTONE, "curvature-lut", ("0.1", "0.5"), _NO_GLOW_FACING),
    (MONOTONE, "curvature-lut-physical", ("0.1", "0.5", "2.0"), _NO_GLOW_FACING),
]


def cases(test: str, models: list[str], values: tuple[object, ...] = ("",)) -> list[ParameterSet]:
    """Return the parameters of a test, with those that a known violation makes fail marked so."""
    return [_case(test, model, value) for value in values for model in models]


def _case(test: str, model: str, value: object) -> ParameterSet:
    arguments = (model,) if value == "" else (model, value)
    for name, which, parts, reason in VIOLATIONS:
        if (name, which) == (test, model) and any(part in str(value) for part in parts):
            return param(
                *arguments, marks=mark.xfail(raises=AssertionError, strict=True, reason=reason)
            )
    return param(*arguments)
