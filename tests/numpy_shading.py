"""Shading in plain NumPy: what the compiled models are compared with, in value and in speed."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lutcore.baking import bake, glowing, resolved
from lutcore.bent import SHARPEST, BentTable
from lutcore.curvature import PrincipalCurvatures
from lutcore.diffusion import diffusion_profile, optics
from lutcore.fresnel import hinges, transmittance
from lutcore.lights import DirectionalLight, Light, PointLight
from lutcore.lut import PsiTable
from lutcore.mesh import TriangleMesh
from plugins.shading.penner2011 import ring_table

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


def lambert(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """Lambert with the mean transmittance."""
    table = bake(material)
    out = np.zeros(mesh.vertices.shape)
    for light in lights:
        w, irradiance = light_vectors(light, mesh.vertices)
        cosine = np.einsum("ij,ij->i", curvatures.normals, w)
        out += irradiance * np.maximum(cosine, 0.0)[:, None]
    return out * (table.total * table.entering)


def wrap(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """Wrap lighting of the default width."""
    table = bake(material)
    out = np.zeros(mesh.vertices.shape)
    for light in lights:
        w, irradiance = light_vectors(light, mesh.vertices)
        cosine = np.einsum("ij,ij->i", curvatures.normals, w)
        out += irradiance * np.maximum((cosine + 0.2) / 1.2, 0.0)[:, None]
    return out * (table.total * table.entering)


def kolchin2007(
    mesh: TriangleMesh, curvatures: PrincipalCurvatures, material: str, lights: Sequence[Light]
) -> FloatArray:
    """The paper's full form from principal curvatures and directions."""
    table = bake(material)
    k1, k2 = np.maximum(curvatures.k1, 0.0), np.maximum(curvatures.k2, 0.0)
    out = np.zeros(mesh.vertices.shape)
    for light in lights:
        w, irradiance = light_vectors(light, mesh.vertices)
        cosine = np.einsum("ij,ij->i", curvatures.normals, w)
        w1 = np.einsum("ij,ij->i", curvatures.d1, w)
        w2 = np.einsum("ij,ij->i", curvatures.d2, w)
        kappa = np.sqrt((w1 * k1) ** 2 + (w2 * k2) ** 2)
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
    bend = 0.5 * (np.maximum(curvatures.k1, 0.0) + np.maximum(curvatures.k2, 0.0))
    out = np.zeros(mesh.vertices.shape)
    for light in lights:
        w, irradiance = light_vectors(light, mesh.vertices)
        cosine = np.einsum("ij,ij->i", curvatures.normals, w)
        for channel, ring in enumerate(rings):
            s = np.minimum(table.mean_free_path[channel] * bend, ring.limit)
            out[:, channel] += irradiance[:, channel] * np.maximum(bent(cosine, s, ring), 0.0)
    return out * (table.total * table.entering)


def bent(a: FloatArray, s: FloatArray, table: BentTable, eta: float = 1.0) -> FloatArray:
    """Return what a table holds, 0 <= s <= its limit."""
    rows, columns = (count - 3 for count in table.coefficients.shape)
    v = np.log1p(s * table.scale) / np.log1p(table.limit * table.scale)
    sigma = SHARPEST + s
    tau = np.arcsinh(a / sigma) / np.arcsinh(1.0 / sigma)
    i, across = bspline(rows * v, rows)
    j, along = bspline(0.5 * columns * (1.0 + tau), columns)
    m = s / (1.0 + s)
    lit = 0.5 * (a + np.sqrt(a * a + m * m))
    total: FloatArray = lit if eta == 1.0 else lit * transmittance(lit, eta)
    for row, p in enumerate(across):
        for column, q in enumerate(along):
            total += p * q * table.coefficients[i + row, j + column]
    return total


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
    for light in lights:
        w, irradiance = light_vectors(light, mesh.vertices)
        cosine = np.einsum("ij,ij->i", curvatures.normals, w)
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
