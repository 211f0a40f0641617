"""The question: a profile, two bodies, loads and friction.

Values that make no contact problem are refused when the scene is built.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from sie import arguments
from sie.numerics.interval import EPS
from sie.profiles.base import Profile

from .material import COUPLINGS, RIGID, Body, Elastic, Rigid, coupling, dundurs, pair_modulus, share

# The loads: what they have to be, and their largest size.
NUMBERS = (
    ("normal_load", arguments.positive, arguments.LARGEST_LOAD),
    ("half_width", arguments.positive, arguments.LARGEST),
    ("tilt", arguments.measure, arguments.LARGEST),
    ("moment", arguments.measure, arguments.LARGEST_COEFFICIENT),
    ("tangential_load", arguments.measure, arguments.LARGEST_LOAD),
    ("bulk_stress", arguments.measure, arguments.LARGEST),
)

# Loads that do not fit together, and what is said of a scene that has them.
UNFIT: tuple[tuple[Callable[[Any], bool], str], ...] = (
    (
        lambda s: s.moment is not None and s.half_width is not None,
        "both half_width = {0.half_width:g} and moment = {0.moment:g} given: give normal_load "
        "beside a moment, or tilt beside a half_width",
    ),
    (
        lambda s: s.moment is not None and s.tilt != 0.0,
        "both tilt = {0.tilt:g} and moment = {0.moment:g} given: give one, the other follows",
    ),
    (
        lambda s: s.tangential_load != 0.0 and s.friction == 0.0,
        "tangential_load = {0.tangential_load:g} without friction: a frictionless contact carries "
        "none; give friction > 0",
    ),
    (
        lambda s: s.sliding and s.tangential_load != 0.0,
        "both sliding = {0.sliding} and tangential_load = {0.tangential_load:g} given: in full "
        "sliding Q = ±f P follows",
    ),
    (
        lambda s: s.sliding and s.friction == math.inf,
        "sliding = {0.sliding} with infinite friction: nothing slides; give a finite friction",
    ),
    (
        lambda s: s.sliding and s.friction == 0.0,
        "sliding = {0.sliding} without friction: there is no shear traction; leave it 0, or give "
        "friction > 0",
    ),
    (
        lambda s: s.coupling == "goodman" and s.friction == math.inf,
        "coupling = 'goodman' with infinite friction: full stick of dissimilar bodies is solved "
        "without an approximation; leave coupling out",
    ),
)


def refuse_no_scene(scene: Any) -> None:
    """ValueError unless it is a scene."""
    if not isinstance(scene, Scene):
        raise ValueError(f"{scene!r} is not a scene: build one with sie.Scene(profile=..., ...)")


@dataclass(frozen=True, kw_only=True)
class Scene:
    """A plane contact problem per unit length of the line of contact, in any consistent units.

    Parameters
    ----------
    profile : Profile
        The gap h(x) between the undeformed indenter and the flat surface of the body.
    body, indenter : Elastic or RIGID
        The two bodies; the indenter is of the body's material if it is not given.
    normal_load : float
        P > 0, force per length. Exactly one of `normal_load` and `half_width` is given.
    half_width : float
        Half-width of the contact, length: of several patches half the distance of the outermost
        edges, per period half of the shortest interval that has all patches of a period. The load
        follows; a half-width that it jumps over, as a patch appears beyond the others, is refused.
    tilt : float, optional
        Angle that is added to the slope of the profile.
    moment : float, optional
        ∫p x dx about x = 0 beside `normal_load`, in place of `tilt`, which is then found.
    friction : float, optional
        Coulomb's coefficient f; inf for full stick (a flat punch).
    tangential_load : float, optional
        Q, force per length.
    bulk_stress : float, optional
        Tension σ along x in the body, stress. Q and σ grow in proportion, after P is applied.
    sliding : {-1, 0, 1}, optional
        +1 or -1: the indenter slides in the direction of ±x, so that q = ±f p and Q follows.
    modulus : float
        E* in place of the bodies, stress.
    dundurs : float, optional
        Dundurs' β beside `modulus`; |β| < 1e-12 is taken for 0. Beside bodies, 0 neglects their β.
    poisson : float, optional
        Poisson's ratio of the body beside `modulus`, for σ_zz.
    coupling : {"full", "goodman"}, optional
        "goodman" leaves β q out of equation (1), so that the pressure is that without friction: an
        approximation for dissimilar bodies.

    Raises
    ------
    ValueError
        For anything that does not make a contact problem, with the value and what to give instead.

    Notes
    -----
    A scene is a value: equal, hashable, picklable, and printed as the code that rebuilds it.

    Examples
    --------
    >>> import sie
    >>> scene = sie.Scene(profile=sie.Parabola(100.0), modulus=80e3, normal_load=50.0)
    >>> round(sie.solve(scene).half_width, 6)
    0.282095
    """

    profile: Profile
    body: Body | None = None
    indenter: Body | None = None
    normal_load: float | None = None
    half_width: float | None = None
    tilt: float = 0.0
    moment: float | None = None
    friction: float = 0.0
    tangential_load: float = 0.0
    bulk_stress: float = 0.0
    sliding: int = 0
    modulus: float | None = None
    dundurs: float | None = None
    poisson: float | None = None
    coupling: str = "full"

    def __post_init__(self) -> None:
        if not isinstance(self.profile, Profile):
            raise ValueError(
                f"profile = {self.profile!r} is not a profile: give sie.Parabola(...), "
                "sie.RoundedFlat(...) or another"
            )
        if self.profile.arrays:
            raise ValueError(
                f"the parameters of {type(self.profile).__name__} are arrays, which are many "
                "scenes: give them to sie.solve_many, or one number each"
            )
        if (self.body is None) == (self.modulus is None):
            what = "neither" if self.body is None else "both"
            raise ValueError(
                f"{what} of body and modulus given: give body = sie.Elastic(young, poisson), or "
                "modulus = E*"
            )
        if self.body is None:
            self._check_modulus()
        else:
            self._check_bodies()
        self._check_loads()

    # -- other forms of a scene --------------------------------------------------------------------

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any]) -> Scene:
        """The scene that tables describe.

        Parameters
        ----------
        tables : mapping
            The tables of a scene file by name, as `to_dict` gives them, as the key "scene" of
            `sie solve --json` holds them, or as `tomllib` reads them. "Infinity" and "-Infinity",
            which JSON has in place of the numbers, are numbers.

        Returns
        -------
        Scene
            The scene, equal to the one that `to_dict` was asked of.

        Raises
        ------
        ValueError
            For tables that describe no contact problem, or a path of several loads.

        Examples
        --------
        >>> import sie
        >>> scene = sie.Scene(profile=sie.Parabola(100.0), modulus=80e3, normal_load=50.0)
        >>> sie.Scene.from_dict(scene.to_dict()) == scene
        True
        """
        from sie.io.scene_tables import arguments_of  # noqa: PLC0415 -- a higher layer

        return cls(**arguments_of(tables))

    def to_dict(self) -> dict[str, Any]:
        """The scene as the tables of a scene file.

        Returns
        -------
        dict
            Tables by name, made of dicts, lists, texts and numbers: json and pickle take them. A
            trace stands in them by its points, not by its file.

        Raises
        ------
        ValueError
            If a scene file cannot name the profile: a Python function, or a sum that was moved as
            a whole.

        Examples
        --------
        >>> import sie
        >>> sie.Scene(profile=sie.Wedge(0.1), modulus=1.0, normal_load=2.0).to_dict()["profile"]
        {'kind': 'wedge', 'slope': 0.1}
        """
        from sie.io.scene_tables import tables_of  # noqa: PLC0415 -- a higher layer

        return tables_of(self)

    # -- checks ------------------------------------------------------------------------------------

    def _check_bodies(self) -> None:
        if self.poisson is not None:
            raise ValueError(f"poisson = {self.poisson!r} follows from the body: leave it out")
        if self.dundurs is not None:
            self._set("dundurs", arguments.finite("dundurs", self.dundurs))
            if self.dundurs != 0.0:
                raise ValueError(
                    f"dundurs = {self.dundurs!r} follows from body and indenter: leave it out, "
                    "or give 0 to neglect β"
                )
        if self.indenter is None:
            self._set("indenter", self.body)
        for name in ("body", "indenter"):
            if not isinstance(getattr(self, name), (Elastic, Rigid)):
                raise ValueError(
                    f"{name} = {getattr(self, name)!r} is not a body: give sie.Elastic(young, "
                    "poisson) or sie.RIGID"
                )
        if self.body == RIGID == self.indenter:
            raise ValueError(
                "body and indenter are both rigid: nothing can deform; give one of them young "
                "and poisson, sie.Elastic(young, poisson)"
            )

    def _check_modulus(self) -> None:
        if self.indenter is not None:
            raise ValueError(
                "indenter without body: with modulus = E* the indenter's constants are in E* "
                "already; leave it out"
            )
        self._set("modulus", arguments.positive("modulus", self.modulus))
        beta = coupling(arguments.finite("dundurs", 0.0 if self.dundurs is None else self.dundurs))
        if abs(beta) > 0.5:
            raise ValueError(
                f"dundurs = {beta:g} is outside [-0.5, 0.5]: no pair of bodies in plane strain has "
                "it"
            )
        self._set("dundurs", beta)
        if self.poisson is not None:
            self._set("poisson", Elastic(1.0, self.poisson).poisson)

    def _check_numbers(self) -> None:
        """Each load is a number of its kind, or not given."""
        for name, checked, largest in NUMBERS:
            if getattr(self, name) is not None:
                self._set(name, checked(name, getattr(self, name), largest))
        self._set("friction", arguments.real("friction", self.friction))
        if self.friction not in (0.0, math.inf):
            arguments.positive("friction", arguments.not_negative("friction", self.friction))
        if not arguments.among(self.sliding, (-1, 0, 1)):
            raise ValueError(
                f"sliding = {self.sliding!r}: give +1 or -1, the direction in which the indenter "
                "slides, or 0"
            )
        self._set("sliding", int(self.sliding))
        if not arguments.among(self.coupling, COUPLINGS):
            raise ValueError(
                f"coupling = {self.coupling!r} is not known: give 'full', or 'goodman' to leave "
                "β q out of the normal equation"
            )

    def _check_loads(self) -> None:
        """The loads fit together."""
        if (self.normal_load is None) == (self.half_width is None):
            what = "neither" if self.normal_load is None else "both"
            raise ValueError(
                f"{what} of normal_load and half_width given: give exactly one, the other follows"
            )
        self._check_numbers()
        for unfit, why in UNFIT:
            if unfit(self):
                raise ValueError(why.format(self))

    def _set(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, value)

    @property
    def slides(self) -> int:
        """+1 or -1 in full sliding, q = ±f p: `sliding` is given, or |Q| = f P to rounding."""
        if self.sliding or self.normal_load is None or self.tangential_load == 0.0 or self.bonded:
            return self.sliding
        limit = self.friction * self.normal_load
        return (
            int(math.copysign(1.0, self.tangential_load))
            if abs(abs(self.tangential_load) - limit) <= 4.0 * EPS * limit
            else 0
        )

    @property
    def bonded(self) -> bool:
        """Full stick: infinite friction."""
        return self.friction == math.inf

    @property
    def coupled(self) -> bool:
        """Whether slip is that of dissimilar bodies in part, where P alone makes a shear."""
        return bool(self.beta and self.friction) and not (self.slides or self.bonded)

    @property
    def neglects_beta(self) -> bool:
        """Whether β q would change the pressure and is left out, in partial slip or in sliding."""
        return bool(self.beta and self.friction) and self.coupling == "goodman"

    @property
    def neglected_beta(self) -> float:
        """β of the bodies where dundurs = 0 leaves it out of a contact with friction, else 0."""
        given = self.body is not None and self.dundurs is not None and self.friction != 0.0
        return dundurs(*self._pair) if given else 0.0

    @property
    def epsilon(self) -> float:
        """ε of the edge exponents in full sliding, 1/2 + ε on the left and 1/2 - ε on the right.

        tan πε = -β f for sliding along +x.
        """
        slides = 0 if self.coupling == "goodman" else self.slides
        return -math.atan(self.beta * self.friction * slides) / math.pi if slides else 0.0

    @property
    def Estar(self) -> float:
        """E*, in units of stress."""
        return pair_modulus(*self._pair) if self.modulus is None else self.modulus

    @property
    def beta(self) -> float:
        """Dundurs' second constant β."""
        return dundurs(*self._pair) if self.dundurs is None else self.dundurs

    @property
    def _pair(self) -> tuple[Body, Body]:
        assert self.body is not None and self.indenter is not None
        return self.body, self.indenter

    @property
    def tau(self) -> float:
        """τ = E*/2 of the strain that the bulk stress σ causes in the body, in units of stress.

        1/π PV∫q/(x - t) dt has this value where the bodies stick (equation (12)): σ/4 for similar
        bodies. With modulus = E* the bodies are taken as similar.
        """
        if self.body is None or self.indenter is None:
            return 0.25 * self.bulk_stress
        return 0.5 * self.bulk_stress * share(self.body, self.indenter)
