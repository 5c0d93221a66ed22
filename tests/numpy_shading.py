"""Shading in plain NumPy: what the compiled models are compared with, in value and in speed."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from lutcore.baking import BETA_FLOOR, bake, glowing, resolved
from lutcore.bent import SHARPEST, BentTable
from lutcore.curvature import PrincipalCurvatures
from lutcore.diffusion import diffusion_profile, optics
from lutcore.fresnel import hinges, transmittance
from lutcore.lights import DirectionalLight, Light, PointLight
from lutcore.lut import PsiTable
from lutcore.mesh import TriangleMesh
from lutcore.monge import LIMIT, TERMS, bake_monge
from plugins.shading.curvature_lut_physical import _inverse_albedo
from plugins.shading.kubo2010 import gaussian_table
from plugins.shading.penner2011 import ring_table
from plugins.shading.sphere_table import sphere_table

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]


def light_vectors(light: Light, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return unit vectors to the light, (n, 3), and its irradiance of a facing surface, (n, 3)."""
    if isinstance(light, DirectionalLight):
        direction = np.asarray(light.direction)
        return np.broadcast_to(direction, points.shape), np.broadcast_to(
            np.asarray(light.irradiance), points.shape
        )
    to_light = np.asarray(light.position) - points
    distance = np.linalg.norm(to_light, axis=1, keepdims=True)
    to_light /= distance
    irradiance = np.asarray(light.intensity) / distance**2
    if not isinstance(light, PointLight):
        inside = -(to_light @ np.asarray(light.direction)) >= np.cos(np.radians(light.angle))
        irradiance = irradiance * inside[:, None]
    return to_light, irradiance


def _falling(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, lights: Sequence[Light]
) -> Iterator[tuple[FloatArray, FloatArray, FloatArray]]:
    """Yield of each light N.w, (n,), its irradiance and w, (n, 3)."""
    for light in lights:
        w, irradiance = light_vectors(light, mesh.vertices)
        yield np.einsum("ij,ij->i", curvatures.normals, w), irradiance, w


def lambert(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """Lambert with the mean transmittance."""
    table = bake(material)
    out = np.zeros(mesh.vertices.shape)
    for cosine, irradiance, _ in _falling(mesh, curvatures, lights):
        out += irradiance * np.maximum(cosine, 0.0)[:, None]
    return out * (table.total * table.entering)


def lambert_directional(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """Lambert with the transmittance of the light's direction."""
    table = bake(material)
    out = np.zeros(mesh.vertices.shape)
    for cosine, irradiance, _ in _falling(mesh, curvatures, lights):
        lit = np.maximum(cosine, 0.0)
        for channel, eta in enumerate(table.eta):
            # Most materials have one index: then its root is taken once.
            if channel == 0 or eta != table.eta[channel - 1]:
                entering = lit * transmittance(lit, eta)
            out[:, channel] += irradiance[:, channel] * entering
    return out * table.total


def bredow2002(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """Wrap lighting by the default angle."""
    table = bake(material)
    out = np.zeros(mesh.vertices.shape)
    for cosine, irradiance, _ in _falling(mesh, curvatures, lights):
        theta = np.arccos(np.clip(cosine, -1.0, 1.0))
        out += irradiance * np.maximum(1.0 - theta / np.radians(110.0), 0.0)[:, None]
    return out * (table.total * table.entering)


def wrap(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """Wrap lighting of the default width."""
    table = bake(material)
    out = np.zeros(mesh.vertices.shape)
    for cosine, irradiance, _ in _falling(mesh, curvatures, lights):
        out += irradiance * np.maximum((cosine + 0.2) / 1.2, 0.0)[:, None]
    return out * (table.total * table.entering)


def kolchin2007(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """The paper's full form from principal curvatures and directions."""
    table = bake(material)
    k1, k2 = np.maximum(curvatures.k1, 0.0), np.maximum(curvatures.k2, 0.0)
    out = np.zeros(mesh.vertices.shape)
    for cosine, irradiance, w in _falling(mesh, curvatures, lights):
        w1 = np.einsum("ij,ij->i", curvatures.d1, w)
        w2 = np.einsum("ij,ij->i", curvatures.d2, w)
        kappa = np.sqrt((w1 * k1) ** 2 + (w2 * k2) ** 2)
        for channel in range(3):
            p = even_form(cosine, table.mean_free_path[channel] * kappa, table, channel)
            out[:, channel] += irradiance[:, channel] * p
    return out * (table.total * table.entering)


def kolchin2007_simplified(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """The paper's section 4, which knows no directions."""
    table = bake(material)
    k1, k2 = np.maximum(curvatures.k1, 0.0), np.maximum(curvatures.k2, 0.0)
    curvature = np.sqrt(0.5 * (k1**2 + k2**2))
    out = np.zeros(mesh.vertices.shape)
    for cosine, irradiance, _ in _falling(mesh, curvatures, lights):
        kappa = np.sqrt(np.maximum(1.0 - cosine**2, 0.0)) * curvature
        for channel in range(3):
            p = even_form(cosine, table.mean_free_path[channel] * kappa, table, channel)
            out[:, channel] += irradiance[:, channel] * p
    return out * (table.total * table.entering)


def penner2011(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """The ring's blur, read from the same tables."""
    table = bake(material)
    profile = diffusion_profile("jensen2001")
    rings = [ring_table(glowing(channel), profile) for channel in optics(resolved(material))]
    lit = _bent_exitance(mesh, curvatures, lights, rings, table.mean_free_path, np.ones(3))
    return lit * (table.total * table.entering)


def kubo2010(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """The Gaussian's blur, read from the same table."""
    table = bake(material)
    sigma_0 = table.mean_free_path * np.sqrt(0.5 * table.mean_square)
    lit = _bent_exitance(mesh, curvatures, lights, [gaussian_table()] * 3, sigma_0, np.ones(3))
    return lit * (table.total * table.entering)


def sphere(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """The sphere that fits best, read from the same tables."""
    table = bake(material)
    profile = diffusion_profile("jensen2001")
    spheres = [sphere_table(glowing(channel), profile) for channel in optics(resolved(material))]
    lit = _bent_exitance(mesh, curvatures, lights, spheres, table.mean_free_path, table.eta)
    return lit * table.total


def _bent_exitance(
    mesh: TriangleMesh,
    curvatures: PrincipalCurvatures,
    lights: Sequence[Light],
    tables: Sequence[BentTable],
    length: FloatArray,
    eta: FloatArray,
) -> FloatArray:
    bend = 0.5 * (np.maximum(curvatures.k1, 0.0) + np.maximum(curvatures.k2, 0.0))
    out = np.zeros(mesh.vertices.shape)
    for cosine, irradiance, _ in _falling(mesh, curvatures, lights):
        for channel, table in enumerate(tables):
            s = np.minimum(length[channel] * bend, table.limit)
            lit = np.maximum(bent(cosine, s, table, eta[channel]), 0.0)
            out[:, channel] += irradiance[:, channel] * lit
    return out


def bent(a: FloatArray, s: FloatArray, table: BentTable, eta: float = 1.0) -> FloatArray:
    """Return what a table holds, 0 <= s <= its limit."""
    (i, across), (j, along) = knots(a, s, table.scale, table.limit, table.coefficients.shape)
    m = s / (1.0 + s)
    lit = 0.5 * (a + np.sqrt(a * a + m * m))
    total: FloatArray = lit if eta == 1.0 else lit * transmittance(lit, eta)
    for row, p in enumerate(across):
        for column, q in enumerate(along):
            total += p * q * table.coefficients[i + row, j + column]
    return total


def knots(
    a: FloatArray, s: FloatArray, scale: float, limit: float, shape: tuple[int, ...]
) -> tuple[tuple[IndexArray, list[FloatArray]], tuple[IndexArray, list[FloatArray]]]:
    """Return `bspline` across the bends and along the cosines of a table."""
    rows, columns = shape[0] - 3, shape[1] - 3
    v = np.log1p(s * scale) / np.log1p(limit * scale)
    sigma = SHARPEST + s
    tau = np.arcsinh(a / sigma) / np.arcsinh(1.0 / sigma)
    return bspline(rows * v, rows), bspline(0.5 * columns * (1.0 + tau), columns)


def bspline(position: FloatArray, last: int) -> tuple[IndexArray, list[FloatArray]]:
    """Return the first coefficient of a cubic B-spline at each position, and four weights."""
    segment = np.clip(position.astype(np.int64), 0, last - 1)
    f = position - segment
    weights = [
        (1.0 - f) ** 3,
        3.0 * f**3 - 6.0 * f**2 + 4.0,
        3.0 * (f + f**2 - f**3) + 1.0,
        f**3,
    ]
    return segment, [weight / 6.0 for weight in weights]


def curvature_lut(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """The default model from principal curvatures and directions, array by array."""
    table = bake(material)
    fits = [hinges(eta, 4) for eta in table.eta]
    k1, k2 = np.maximum(curvatures.k1, 0.0), np.maximum(curvatures.k2, 0.0)
    out = np.zeros(mesh.vertices.shape)
    for cosine, irradiance, w in _falling(mesh, curvatures, lights):
        w1 = np.einsum("ij,ij->i", curvatures.d1, w)
        w2 = np.einsum("ij,ij->i", curvatures.d2, w)
        kappa = np.sqrt((w1 * k1) ** 2 + (w2 * k2) ** 2)
        for channel in range(3):
            b = table.mean_free_path[channel] * kappa
            glow = np.zeros(len(b))
            fit = fits[channel]
            for corner, weight in zip(fit.corners, fit.weights, strict=True):
                glow += weight * even_form(cosine - corner, b, table, channel)
            out[:, channel] += irradiance[:, channel] * glow
    for channel in range(3):
        second = table.mean_square[channel] * table.mean_free_path[channel] ** 2 / 16.0
        second = second * (3.0 * k1**2 + 2.0 * k1 * k2 + 3.0 * k2**2)
        out[:, channel] *= table.total[channel] / (1.0 + second)
    return out


def even_form(a: FloatArray, b: FloatArray, table: PsiTable, channel: int) -> FloatArray:
    """Return max(a, 0) + b psi(|a|/b)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        u = np.abs(a) / b
    position = np.arcsinh(u) * table.inverse_step[channel]
    within = position < table.samples - 1
    position = np.where(within, position, 0.0)
    segment = position.astype(np.int64)
    t = position - segment
    c0, c1, c2, c3 = table.rows[channel, segment].T
    psi = c0 + t * (c1 + t * (c2 + t * c3))
    return np.maximum(a, 0.0) + np.where(within, b * psi, 0.0)


def curvature_lut_physical(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """The physical model; 1/rho by the same polynomial in the inner cosine and in x."""
    table, media = bake(material), optics(resolved(material))
    out = np.zeros(mesh.vertices.shape)
    for channel, medium in enumerate(media):
        beta, eta, length = max(medium.beta, BETA_FLOOR), medium.eta, table.mean_free_path[channel]
        k1, k2 = (np.maximum(k, 0.0) * length for k in (curvatures.k1, curvatures.k2))
        with np.errstate(divide="ignore", over="ignore"):
            y = 2.0 * beta / (k1 + k2)
        near = np.minimum(y, 20.0)  # coth y is 1 beyond
        x = 1.0 / np.tanh(near) - 1.0 / near
        wider = near * (near / x - 2.0 - near * x)
        x = np.where(y > 20.0, 1.0 - 1.0 / y, x)
        wider = np.where(y > 20.0, 1.0 + 1.0 / (y - 1.0), wider)
        powers = _inverse_albedo(medium) @ np.vander(x, 5, increasing=True).T
        second = table.mean_square[channel] / 16.0 * (3.0 * k1**2 + 2.0 * k1 * k2 + 3.0 * k2**2)
        fit = hinges(eta, 4)
        for cosine, irradiance, w in _falling(mesh, curvatures, lights):
            w1 = np.einsum("ij,ij->i", curvatures.d1, w)
            w2 = np.einsum("ij,ij->i", curvatures.d2, w)
            kappa, bulge = np.hypot(w1 * k1, w2 * k2), k1 * w1**2 + k2 * w2**2
            g = _displaced(_inner(np.clip(cosine, 0.0, 1.0), eta), beta, eta, k1, k2)
            entry = (cosine + g * bulge) / np.sqrt(1.0 + (g * kappa) ** 2)
            lit = np.clip(entry, 0.0, 1.0)
            inner = _inner(lit, eta)
            g = _displaced(inner, beta, eta, k1, k2)
            lost = powers[0] + inner * (powers[1] + inner * powers[2])
            widened = (1.0 + g * lit * k1) * (1.0 + g * lit * k2)
            factor = (1.0 + beta * g**2 * bulge) / (widened * lost * (1.0 + wider * second))
            b = np.sqrt(wider) * kappa
            for corner, weight in zip(fit.corners, fit.weights, strict=True):
                glow = weight * even_form(entry - corner, b, table, channel)
                out[:, channel] += irradiance[:, channel] * factor * glow
    return out


def _inner(lit: FloatArray, eta: float) -> FloatArray:
    return np.sqrt(1.0 - (1.0 - lit**2) / eta**2)


def _displaced(
    inner: FloatArray, beta: float, eta: float, k1: FloatArray, k2: FloatArray
) -> FloatArray:
    g = 1.0 / (eta * (1.0 + beta * inner))
    return np.asarray(g / np.sqrt(1.0 + g**2 * (k1**2 + k2**2)))


def monge_patch(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """The quadratic patch, read from the same tables."""
    table, profile = bake(material), diffusion_profile("jensen2001")
    patches = [bake_monge(profile, glowing(channel)) for channel in optics(resolved(material))]
    k1, k2 = np.maximum(curvatures.k1, 0.0), np.maximum(curvatures.k2, 0.0)
    squares = k1**2 + k2**2
    curvature = np.sqrt(0.5 * squares)
    p = np.clip(2.0 - (k1 + k2) ** 2 / squares, 0.0, 1.0)
    out = np.zeros(mesh.vertices.shape)
    for a, irradiance, w in _falling(mesh, curvatures, lights):
        w1 = np.einsum("ij,ij->i", curvatures.d1, w)
        w2 = np.einsum("ij,ij->i", curvatures.d2, w)
        bend = np.hypot(w1 * k1, w2 * k2)
        sine = np.sqrt(np.maximum(1.0 - a**2, 0.0))
        q = np.minimum(bend / (curvature * sine + 1e-300), np.sqrt(2.0))
        powers = np.stack([p**i * (q - 1.0) ** j for i, j in TERMS], axis=1)
        reach = np.sqrt(bend**2 + (a * curvature) ** 2)
        for channel, patch in enumerate(patches):
            s = np.minimum(table.mean_free_path[channel] * curvature, LIMIT)
            e = np.minimum(reach * (s / curvature), patch.round_.limit)
            value = bent(a, e, patch.round_, table.eta[channel])
            (i, across), (j, along) = knots(a, s, patch.scale, LIMIT, patch.terms.shape)
            for row, p_row in enumerate(across):
                for column, p_column in enumerate(along):
                    terms = patch.terms[i + row, j + column]
                    value += p_row * p_column * np.einsum("nt,nt->n", terms, powers)
            out[:, channel] += irradiance[:, channel] * np.maximum(value, 0.0)
    return out * table.total


def gather(
    mesh: TriangleMesh,
    curvatures: PrincipalCurvatures,
    material: str,
    lights: Sequence[Light],
    points: FloatArray,
) -> FloatArray:
    """The dipole summed over every triangle in 64 parts, at some points."""
    substance, profile = resolved(material), diffusion_profile("jensen2001")
    entering = np.zeros(mesh.vertices.shape)
    for cosine, irradiance, _ in _falling(mesh, curvatures, lights):
        lit = np.maximum(cosine, 0.0)
        let_in = np.stack([lit * transmittance(lit, eta) for eta in substance.eta], axis=1)
        entering += irradiance * let_in
    upright = [(i + 1 / 3, j + 1 / 3) for i in range(8) for j in range(8 - i)]
    inverted = [(i + 2 / 3, j + 2 / 3) for i in range(8) for j in range(7 - i)]
    first, second = np.array(upright + inverted).T / 8.0
    middles = np.stack([first, second, 1.0 - first - second], axis=1)
    corners = mesh.vertices[mesh.faces]
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(crosses, axis=1) / (2.0 * len(middles))
    power = np.einsum("qk,mkc,m->mqc", middles, entering[mesh.faces], area).reshape(-1, 3)
    places = np.einsum("qk,mkx->mqx", middles, corners).reshape(-1, 3)
    bright = power.any(axis=1)
    power, places = power[bright], places[bright]
    out = np.empty(points.shape)
    for row, point in enumerate(points):
        distance = np.linalg.norm(places - point, axis=1)
        for channel, medium in enumerate(optics(substance)):
            length = medium.mean_free_path
            spread = profile.radial(distance / length, medium) / length**2
            out[row, channel] = spread @ power[:, channel]
    return out
