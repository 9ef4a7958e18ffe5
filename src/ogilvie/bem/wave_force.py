"""Force of waves on the hull from what its motion radiates (Haskind), frequency by frequency."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.coupled import CoupledSystem
from ogilvie.bem.curved import BODY
from ogilvie.memory.fourier import fourier_integral, legendre_pieces

Array = NDArray[Any]


def wave_force(
    system: CoupledSystem, rate: Array, *, dt: float, omega: Array, direction: Array, centre: Array | None = None
) -> tuple[Array, Array]:
    """Return Froude-Krylov and diffraction forces (n_w, n_b, n_dofs) of unit waves, in units of control radius and gravity.

    Parameters
    ----------
    system : CoupledSystem
        Of one class of symmetry: the part of the force on its dofs.
    rate : (n_t, n_hull, n_dofs) array
        Rate of the memory potential at the hull's nodes after a unit impulse in each dof, times sqrt(weight): `inputs` of the
        system as outputs of :func:`ogilvie.bem.stepping.impulse_response`.
    dt : float
        Its step.
    omega, direction : (n_w,), (n_b,) array
    centre : (3,) array, optional
        Of the control hemisphere from O, in control radii.

    Notes
    -----
    With phi_I = (i g/omega) exp(kz - ik(x cos b + y sin b)), normals n out of the fluid, the pressure -i omega rho phi and the
    radiation potentials phi_j of unit velocities (d phi_j/dn = n_j),

        X_j = -i omega rho int phi_I n_j dS + i omega rho int phi_j d phi_I/dn dS,   i omega phi_j = FT(rate) + i omega M n_j,

    M the instantaneous map. The phase is that of a wave whose crest passes O at t = 0.

    References
    ----------
    M. D. Haskind (1957); J. N. Newman, Journal of Ship Research 6 (1962) 10.
    """
    nodes, inner = system.inner.nodes, system.inner
    hull = nodes.part == BODY
    position, normal = nodes.position[hull], nodes.normal[hull]
    t = dt * np.arange(len(rate))
    radiated = np.conj(fourier_integral(t, legendre_pieces(t, rate, "spline"), omega))  # (n_w, n_hull, n_dofs)
    radiated = radiated + 1j * omega[:, None, None] * (system.instantaneous @ system.motions.T)
    k = omega**2
    level = np.zeros((len(omega), len(direction), hull.sum()), dtype=complex)
    slope = np.zeros_like(level)
    cos, sin = np.cos(direction)[None, :, None], np.sin(direction)[None, :, None]
    x0, y0 = (0.0, 0.0) if centre is None else centre[:2]
    for sign_x, sign_y in nodes.mesh.images:
        x, y = sign_x * position[:, 0] + x0, sign_y * position[:, 1] + y0
        parity = (inner.parity[0] if sign_x < 0 else 1.0) * (inner.parity[1] if sign_y < 0 else 1.0)
        wave = parity * np.exp(k[:, None, None] * (position[:, 2] - 1j * (x * cos + y * sin)))
        level += wave
        slope += wave * (normal[:, 2] - 1j * (sign_x * normal[:, 0] * cos + sign_y * normal[:, 1] * sin))
    weight = inner.root_weight[hull] / len(nodes.mesh.images)
    froude_krylov = np.einsum("wbn,jn->wbj", level * weight, system.motions, optimize=True)
    velocity = 1j * omega[:, None, None] * slope * weight  # (i g/omega) k = i omega
    return froude_krylov, np.einsum("wbn,wnj->wbj", velocity, radiated, optimize=True)
