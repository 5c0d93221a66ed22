"""What other packages' estimators are known not to do, and why; anything else must pass.

Each row: the test, a part of its parameters' names (empty for all of them), the reason, the
methods. A row that no longer fails is reported as well, unless it fails only sometimes.
"""

VALUES = "test_values_signs_and_directions_on_exact_surfaces"
PROMISES = "test_promises_hold_on_meshes_that_nobody_vetted"
TRIANGLE = "test_a_single_triangle_is_flat"
FLAT = "test_a_flat_grid_is_flat_up_to_its_rim"
RIMS = "test_rims_do_not_glare"
FLIPPED = "test_flipped_faces_negate"
ORDER = "test_order_of_vertices_and_faces_does_not_matter"
SOUP = "test_soup_gets_the_values_of_the_joined_mesh"
ISLANDS = "test_islands_do_not_disturb_each_other"

MESHLAB_MANIFOLD = (
    "meshlab-discrete",
    "meshlab-normal-cycles",
    "meshlab-quadric",
    "meshlab-scaled-quadric",
    "meshlab-taubin",
)

SOMETIMES = "crashes where its length holds a whole island, but not every time"

KNOWN: list[tuple[str, str, str, tuple[str, ...]]] = [
    (VALUES, "", "takes edges for evenly spread", ("meshlab-taubin",)),
    (VALUES, "True", "one-ring angles on random triangles", ("vtk", "meshlab-discrete")),
    (VALUES, "sphere-False", "one-ring angles at stars of five and seven", ("vtk",)),
    (VALUES, "True", "one-ring angles on random triangles", ("meshlab-normal-cycles",)),
    (
        VALUES,
        "cylinder-False",
        "takes developable stars for degenerate",
        ("meshlab-normal-cycles",),
    ),
    (VALUES, "torus-False", "loses a negative curvature", ("meshlab-normal-cycles",)),
    (VALUES, "saddle-False", "loses a negative curvature", ("meshlab-normal-cycles",)),
    (VALUES, "sphere", "sum of angles jumps as vertices enter the ball", ("trimesh",)),
    (VALUES, "cylinder-False", "sum of angles jumps as vertices enter the ball", ("trimesh",)),
    (VALUES, "torus", "five rings are half the tube's radius: bias", ("libigl",)),
    (FLIPPED, "", "loses the most negative curvature of either side", ("meshlab-normal-cycles",)),
    (FLIPPED, "", "at rims the order of the faces decides", ("meshlab-quadric", "meshlab-taubin")),
    (FLIPPED, "", "the order of the faces decides", ("meshlab-scaled-quadric",)),
    (ORDER, "", "the order of the faces decides", ("meshlab-quadric", "meshlab-taubin")),
    (ORDER, "", "the fit's frame follows the order", ("libigl", "meshlab-scaled-quadric")),
    (SOUP, "", "the fit's frame follows the order", ("libigl", "meshlab-scaled-quadric")),
    (TRIANGLE, "", "angles at a rim count as a full turn", ("meshlab-discrete",)),
    (TRIANGLE, "", "too few neighbours for the fit", ("meshlab-quadric",)),
    (TRIANGLE, "", "refused: no two faces meet", ("trimesh",)),
    (TRIANGLE, "", "never ends", ("meshlab-scaled-quadric",)),
    (FLAT, "", "angles at a rim count as a full turn", ("meshlab-discrete",)),
    (FLAT, "", "too few neighbours at corners of the rim", ("meshlab-quadric",)),
    (RIMS, "", "angles at a rim count as a full turn", ("vtk", "meshlab-discrete")),
    (RIMS, "", "one-ring angles on random triangles", ("meshlab-normal-cycles", "meshlab-taubin")),
    (PROMISES, "nonmanifold", "refused: not two-manifold", MESHLAB_MANIFOLD),
    (PROMISES, "double_sided", "refused: not two-manifold", MESHLAB_MANIFOLD),
    (PROMISES, "double_sided", "crashes where four faces meet at an edge", ("libigl",)),
    (ISLANDS, "", "errs by more than a twentieth on the large sphere", ("vtk", "trimesh")),
    (ISLANDS, "", "errs on the coarse sphere", MESHLAB_MANIFOLD + ("libigl",)),
    (ISLANDS, "", SOMETIMES, ("meshlab-apss",)),
    (PROMISES, "islands", SOMETIMES, ("meshlab-apss",)),
]

ENDLESS = {(TRIANGLE, "meshlab-scaled-quadric")}
"""Those that would run into their time limit; `test_peers` does that with a short one."""


def known_failure(test: str, parameters: str, method: str) -> str:
    """Return why a method is known to fail a test, or nothing."""
    for name, part, reason, methods in KNOWN:
        if name == test and part in parameters and method in methods:
            return reason
    return ""
