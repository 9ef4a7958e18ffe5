"""Influence matrices of mirror images, put together by parity in their own place."""

import numpy as np
import pytest

from ogilvie.hydro import bem_parity
from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.hydro.bem_parity import parities
from ogilvie.hydro.drift_solve import fields_at, gathered
from ogilvie.mesh import shapes


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("symmetry", ["none", "xz", "xz+yz"])
def test_sums_over_copies_are_those_of_the_definition(symmetry, order, monkeypatch):
    monkeypatch.setattr(bem_parity, "_CHUNK", 20)  # several pieces per matrix
    panels = HullPanels(shapes.box(2.0, 1.0, 0.5, panels=40).with_symmetry(symmetry))
    rng = np.random.default_rng(4)
    images, table = panels.images, parities(panels)

    def matrix(*shape):
        return np.asarray(rng.normal(size=shape) + 1j * rng.normal(size=shape), order=order)

    copies = [(matrix(7, 5), np.stack([matrix(7, 5) for _ in range(3)])) for _ in images]
    expected = [
        (
            sum(sign * S for sign, (S, _) in zip(signs, copies, strict=True)),
            sum(sign * G * image[:, None, None] for sign, (_, G), image in zip(signs, copies, images, strict=True)),
        )
        for signs in table
    ]
    strengths = rng.normal(size=(3, len(table), 5)) + 0j
    sources = iter([(S.copy(), G.copy()) for S, G in copies])
    fields = fields_at(panels, lambda points, image: next(sources), strengths, np.zeros((7, 3)))
    for s, ((S, G), (S0, G0)) in enumerate(zip(gathered(copies, images), expected, strict=True)):
        np.testing.assert_allclose(S, S0, atol=1e-13)
        np.testing.assert_allclose(G, G0, atol=1e-13)
        np.testing.assert_allclose(fields.potential[:, s], strengths[:, s] @ S0.T, atol=1e-12)
        np.testing.assert_allclose(fields.velocity[:, s], np.einsum("ipq,fq->fpi", G0, strengths[:, s]), atol=1e-12)
