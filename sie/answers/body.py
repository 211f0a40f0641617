"""The stress in the body under the tractions of a solution, as its attributes and methods."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from sie.errors import ContactError
from sie.problem.coverage import refuse_unknown_poisson
from sie.problem.material import Elastic
from sie.traction.combination import scaled

if TYPE_CHECKING:
    from sie.cracks.edge_intensity import EdgeIntensity
    from sie.io.boundary_data import BoundaryData
    from sie.stress.displacement import Displacement
    from sie.stress.half_plane import Stress, Tractions
    from sie.stress.yield_limit import Criterion, Peak, YieldPoint

    from .sheared import Sheared as Stages  # a part of a solution, which has the stages
else:
    Stages = object


class BodyAnswers(Stages):
    """What a solution answers about the body below the surface, and next to the edges."""

    @cached_property
    def tractions(self) -> Tractions:
        """The tractions and the constants that the stress in the body depends on."""
        found = self.tractions_of("body")
        if found is None:
            raise ContactError(
                "the body is rigid: its stress is not determined; give the elastic one as body and "
                "the rigid as indenter"
            )
        return found

    def tractions_of(self, name: str) -> Tractions | None:
        """The same of the body or, mirrored at the surface, of the indenter; None if it is rigid.

        The indenter bears -q, and no bulk stress.
        """
        from sie.stress.half_plane import Tractions

        scene = self.scene
        body, shear, bulk = scene.body, self.shear, scene.bulk_stress
        if name == "indenter":
            body, shear, bulk = scene.indenter, scaled(-1.0, shear), 0.0
        if body is None:
            return Tractions(self.pressure, shear, bulk, scene.poisson)
        if isinstance(body, Elastic):
            return Tractions(self.pressure, shear, bulk, body.poisson, body.plane, body)
        return None

    def stress(self, x: ArrayLike, y: ArrayLike) -> Stress:
        """The stress at points of the body.

        Parameters
        ----------
        x, y : array_like of float
            Positions and depths, y >= 0, length. They are broadcast against each other.

        Returns
        -------
        Stress
            Components, invariants and strains, arrays of the broadcast shape, computed as they are
            read.

        Raises
        ------
        ValueError
            For points above the surface or not finite.
        ContactError
            If the body is rigid.
        """
        from sie.stress.half_plane import Stress

        return Stress(self.tractions, x, y)

    def displacement(
        self,
        x: ArrayLike,
        y: ArrayLike,
        body: str = "body",
        *,
        zero: Sequence[float] | None = None,
        rotation: float = 0.0,
    ) -> Displacement:
        """The displacement at points of the body or of the indenter, exact up to the surface.

        Parameters
        ----------
        x, y : array_like of float
            Positions and depths, length: y >= 0 in the body, y <= 0 in the indenter. They are
            broadcast against each other.
        body : {"body", "indenter"}, optional
            Whose displacement.
        zero : (float, float), optional
            The point of the body that keeps its place; ten half-widths below the middle of the
            contact if it is not given, and one period of a periodic contact.
        rotation : float, optional
            Rotation of both bodies at infinity, radians, from x towards y.

        Returns
        -------
        Displacement
            `.x` and `.y`, lengths, of the broadcast shape; `.approach` of the bodies.

        Raises
        ------
        ValueError
            For points outside of the body, and where the scene has a modulus in place of bodies.

        Notes
        -----
        The displacement of a half-plane grows like the logarithm of the distance: one point is
        held. The indenter moves from where its gap is the profile's h(x), so that on the surface
        u_y of the body less u_y of the indenter is gap(x) - h(x); a tilt of the scene is a
        rotation of the indenter. Along x it moves by the slip in the middle of the widest stick
        zone, or not at all in the middle of the contact if the slip is not known. Bulk stress is
        in the body alone. A rigid body moves as a whole.

        References
        ----------
        Muskhelishvili, Some Basic Problems of the Mathematical Theory of Elasticity (1953), § 93.

        Examples
        --------
        >>> import sie
        >>> steel = sie.Elastic(young=210e3, poisson=0.3)
        >>> scene = sie.Scene(profile=sie.Parabola(50.0), body=steel, normal_load=500.0)
        >>> solution = sie.solve(scene)
        >>> x = 0.4 * solution.half_width
        >>> below, above = (solution.displacement(x, 0.0, body=b) for b in ("body", "indenter"))
        >>> bool(abs(above.y - below.y - scene.profile.height(x)) < 1e-15)
        True
        """
        from sie.stress.displacement import displacement_of  # what is not asked for is not imported

        return displacement_of(self, x, y, body, zero=zero, rotation=rotation)

    def boundary_data(
        self,
        points: ArrayLike | None = None,
        *,
        box: Sequence[float] | None = None,
        spacing: float | None = None,
        kind: str = "displacement",
        body: str = "body",
        labels: ArrayLike | None = None,
        zero: Sequence[float] | None = None,
        rotation: float = 0.0,
    ) -> BoundaryData:
        """Exact displacements or tractions on the boundary of a mesh in one of the bodies.

        Parameters
        ----------
        points : array_like of float, optional
            Rows (x, y), shape (n, 2), length, with y downward; or `box`.
        box : (float, float, float, float), optional
            (x0, x1, y0, y1): its sides, without the surface y = 0.
        spacing : float, optional
            Distance of points on the sides, about; a fortieth of the width if not given.
        kind : {"displacement", "traction"}, optional
            What is asked for; tractions with their nodal forces.
        body : {"body", "indenter"}, optional
            The body, y >= 0, or the indenter, y <= 0.
        labels : array_like of int, optional
            Numbers of the points as nodes of a mesh; from 1 if not given.
        zero, rotation
            The gauge, as of `displacement`.

        Returns
        -------
        BoundaryData
            `.x`, `.y`, `.values`; `.write("boundary.csv")`, or .inp for lines of a deck.

        Raises
        ------
        ValueError
            For points outside of the body; for tractions at points that are on no side of the box
            around them; for tractions in a rigid body.

        Examples
        --------
        >>> import sie
        >>> steel = sie.Elastic(young=210e3, poisson=0.3)
        >>> scene = sie.Scene(profile=sie.Parabola(50.0), body=steel, normal_load=500.0)
        >>> data = sie.solve(scene).boundary_data(box=(-2.0, 2.0, 0.0, 2.0), kind="traction")
        >>> round(data.resultant[1], 10)
        -500.0
        """
        from sie import __version__
        from sie.io.boundary_data import asked_places, boundary_data  # a higher layer

        places = asked_places(points, box, spacing, kind)
        about = f"sie {__version__}: {kind} in the {body}", repr(self.scene)
        moved = partial(self.displacement, body=body, zero=zero, rotation=rotation)
        moved(*places.T[:, :0])  # refuses another name
        loads = self.tractions_of(body)
        return boundary_data(moved, loads, places, kind, about=about, labels=labels)

    def surface_stress(self, x: ArrayLike) -> Stress:
        """The stress on the surface, in the contact and beside it.

        Parameters
        ----------
        x : array_like of float
            Positions at y = 0, length.

        Returns
        -------
        Stress
            As `stress(x, 0.0)`.
        """
        return self.stress(x, 0.0)

    def elastic_limit(self, criterion: Criterion = "mises") -> YieldPoint:
        """The place where the body yields first, and the load.

        Parameters
        ----------
        criterion : {"mises", "tresca"}, optional
            Yield criterion.

        Returns
        -------
        YieldPoint
            First-yield load, place and stress.

        Raises
        ------
        ValueError
            For an unknown criterion, or if Poisson's ratio is needed and not given.

        Examples
        --------
        >>> import sie
        >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, poisson=0.3, normal_load=1.0)
        >>> found = sie.solve(scene).elastic_limit()
        >>> round(found.y / found.half_width, 2)
        0.7
        """
        from sie.stress.yield_limit import elastic_limit, refuse_unknown_criterion

        refuse_unknown_criterion(criterion)
        refuse_unknown_poisson(self.scene)
        return elastic_limit(self.tractions, self.normal_load, criterion)

    def peak_tension(self) -> Peak:
        """The largest tension σ_xx on the surface.

        Returns
        -------
        Peak
            (value, x): stress, and the position where it is reached, in the contact or beside it.
        """
        from sie.stress.yield_limit import peak_tension

        return peak_tension(self.tractions)

    def edge_intensity(self, side: str) -> EdgeIntensity:
        """What the stress next to an edge depends on: its intensities, and how far they hold.

        Parameters
        ----------
        side : {"left", "right"}
            The edge.

        Returns
        -------
        EdgeIntensity
            `.normal` K_N, `.tangential` K_T in full stick, `.slip_length` and `.reach`.

        Raises
        ------
        ValueError
            For another side.
        ContactError
            For a contact in several patches, and for dissimilar bodies with friction, whose edges
            have other powers.

        Examples
        --------
        >>> import math, sie
        >>> scene = sie.Scene(profile=sie.Parabola(1.0), modulus=1.0, normal_load=math.pi / 4)
        >>> round(sie.solve(scene).edge_intensity("left").normal, 12)  # p0 sqrt(2/b) = sqrt(2)/2
        0.707106781187
        """
        if side not in ("left", "right"):
            raise ValueError(f'side = {side!r} is no edge: give "left" or "right"')
        if self.scene.beta and self.scene.friction:
            raise ContactError(
                f"dissimilar bodies (β = {self.scene.beta:.4g}) with friction have other powers at "
                "their edges than a root: give dundurs = 0 to neglect β"
            )
        if self._several is not None:
            raise ContactError(
                f"contact in {len(self.patches)} patches: what sticks at one edge depends on all; "
                "give the profile of one patch and its load"
            )
        from sie.cracks.edge_intensity import edge_intensity

        left = side == "left"
        loads = self.tangential_load, self.scene.tau
        return edge_intensity(
            self.pressure, self.sharp[0 if left else 1], left, loads, self.scene.friction
        )
