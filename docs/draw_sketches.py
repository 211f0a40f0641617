"""The sketches that open the pages of the explanation: one style, light and dark.

    python docs/draw_sketches.py FOLDER

writes NAME-light.svg and NAME-dark.svg for each sketch; the build of the site does it by itself.
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure

THEMES = {  # ink, body, pressure, shear and slip
    "light": ("#222222", "#dfe7ee", "#1f5fa8", "#c2501a"),
    "dark": ("#e8e8e8", "#2c3a47", "#7db4ee", "#f0925f"),
}
STYLE = {
    "svg.fonttype": "path",
    "svg.hashsalt": "sketch",
    "mathtext.fontset": "cm",
    "font.size": 13,
}


class Sketch:
    """A drawing with the half-plane below, y downwards as in the equations."""

    def __init__(self, theme, top=-1.3, bottom=1.0, half_width=2.4):
        self.ink, self.body, self.blue, self.red = THEMES[theme]
        size = (1.9 * half_width, 0.95 * (bottom - top))
        self.figure = Figure(figsize=size, facecolor="none")
        self.ax = self.figure.add_axes((0.0, 0.0, 1.0, 1.0), facecolor="none")
        self.ax.set(xlim=(-half_width, half_width), ylim=(bottom, top))
        self.ax.axis("off")
        self.half_width, self.bottom = half_width, bottom

    def line(self, x, y, color=None, **kind):
        self.ax.plot(x, y, color=color or self.ink, **({"lw": 1.3} | kind))

    def text(self, x, y, text, color=None, **kind):
        kind = {"ha": "center", "va": "center"} | kind
        self.ax.text(x, y, text, color=color or self.ink, **kind)

    def arrow(self, start, end, color=None, *, style="-|>", text="", at=None):
        arrow = {"arrowstyle": style, "color": color or self.ink, "lw": 1.3, "mutation_scale": 11}
        self.ax.annotate("", end, start, arrowprops=arrow | {"shrinkA": 0, "shrinkB": 0})
        if text:
            self.text(*at, text, color)

    def dimension(self, lo, hi, y, text, color=None):
        self.arrow((lo, y), (hi, y), color, style="<|-|>")
        self.text((lo + hi) / 2, y + 0.16, text, color)

    def half_plane(self, surface=None, label="$E,\\ \\nu$"):
        """The body, its free surface at 0 or bent as given; x and y from the origin."""
        x = np.linspace(-self.half_width, self.half_width, 400)
        y = np.zeros_like(x) if surface is None else surface(x)
        self.ax.fill_between(x, y, self.bottom, color=self.body, lw=0)
        self.line(x, y)
        self.text(-self.half_width + 0.45, self.bottom - 0.3, label)

    def axes(self, x=1.85, y=0.75):
        self.arrow((0, 0), (x, 0), text="$x$", at=(x + 0.12, 0.15))
        self.arrow((0, 0), (0, y), text="$y$", at=(0.14, y))

    def indenter(self, height, half_width=1.6, top=-1.05, hatch=True):
        x = np.linspace(-half_width, half_width, 400)
        self.line(x, -height(x))
        self.line([x[0]] * 2, [-height(x[0]), top])
        self.line([x[-1]] * 2, [-height(x[-1]), top])
        if hatch:
            self.line(x[[0, -1]], [top, top])

    def zones(self, c, slip_at):
        """Stick in (-c, c) and slip beside it on a contact (-1, 1), with their widths."""
        self.line([-c, c], [0, 0], self.blue, lw=4)
        for sign in (-1, 1):
            self.line([sign, c * sign], [0, 0], self.red, lw=4)
            self.text(slip_at * sign, 0.2, "slip", self.red)
        self.text(0.0, 0.2, "stick", self.blue)
        self.dimension(-c, c, 0.45, "$2c$", self.blue)
        self.dimension(-1, 1, 0.72, "$2b$")

    def pressure(self, x, p, scale=0.5, count=13, color=None):
        """Arrows on the surface from a curve of the pressure above it."""
        color = color or self.blue
        self.line(x, -scale * p, color)
        for place in np.linspace(x[0], x[-1], count + 2)[1:-1]:
            height = scale * np.interp(place, x, p)
            if height > 0.12:
                self.arrow((place, -height), (place, 0.0), color)


def rounded(x, a=0.5):
    """The height of a flat punch with rounded edges."""
    return 0.45 * np.maximum(np.abs(x) - a, 0.0) ** 2


def hertz(count=201):
    x = np.linspace(-1.0, 1.0, count)
    return x, np.sqrt(1.0 - x**2)


def equation(theme):
    s = Sketch(theme, top=-1.75)
    s.half_plane()
    s.indenter(lambda x: rounded(x) + 0.03, top=-1.1)
    s.arrow((0, -1.7), (0, -1.1), text="$P$", at=(0.17, -1.55))
    s.arrow((-0.75, -0.85), (-0.2, -0.85), s.red, text="$Q$", at=(-0.9, -0.85))
    s.arrow((1.35, 0.0), (1.35, -rounded(1.35)), style="<|-|>", text="$h(x)$", at=(1.72, -0.25))
    for place in np.linspace(-0.8, 0.8, 9):
        s.arrow((place, 0.02), (place, 0.02 + 0.42 * np.sqrt(1 - place**2)), s.blue)
    s.text(-0.7, 0.6, "$p(x)$", s.blue)
    s.line([-1, -1], [-0.1, 0.1])
    s.line([1, 1], [-0.1, 0.1])
    s.text(-1.15, 0.25, "$x_1$")
    s.text(1.15, 0.25, "$x_2$")
    s.axes(2.1, 0.85)
    return s.figure


def gauss_chebyshev(theme):
    s = Sketch(theme, top=-1.3, bottom=0.45, half_width=1.7)
    angle = np.linspace(0, np.pi, 200)
    s.line(np.cos(angle), -np.sin(angle))
    s.line([-1.3, 1.3], [0, 0])
    for k in range(1, 9):
        t = np.pi * (2 * k - 1) / 16
        s.line([np.cos(t)] * 2, [-np.sin(t), 0], s.blue, lw=0.8, ls=":")
        s.line([np.cos(t)], [0], s.blue, marker="o", ms=6)
        if k < 8:
            s.line([np.cos(np.pi * k / 8)], [0], s.red, marker="x", ms=6)
    s.text(np.cos(np.pi * 3 / 16), 0.22, "$t_k$", s.blue)
    s.text(np.cos(np.pi * 5 / 8), 0.22, "$x_j$", s.red)
    s.text(-1.0, 0.22, "$-1$")
    s.text(1.0, 0.22, "$1$")
    s.text(0, -1.12, "equal angles $\\theta$")
    return s.figure


def kinks(theme):
    s = Sketch(theme, top=-1.5, bottom=1.3)
    s.ax.fill_between([-2.4, 2.4], 0, 0.12, color=s.body, lw=0)
    s.line([-2.4, 2.4], [0, 0])
    s.indenter(lambda x: rounded(x) + 0.03, top=-1.0)
    s.dimension(-0.5, 0.5, -0.35, "$2a$, flat")
    s.text(1.1, -0.75, "radius $R$")
    x = np.array([-1.6, -0.5, 0.5, 1.6])
    s.line([-2.0, 2.0], [0.75, 0.75], lw=0.8)
    s.line(x, 0.75 - 0.4 * np.sign(x) * np.maximum(np.abs(x) - 0.5, 0), s.blue, lw=1.8)
    for corner in (-0.5, 0.5):
        s.line([corner] * 2, [0, 0.75], lw=0.8, ls=":")
        s.line([corner], [0.75], s.red, marker="o", ms=6)
    s.text(1.85, 0.3, "$h'(x)$", s.blue)
    s.text(0.75, 1.0, "kink", s.red)
    return s.figure


def edges(theme):
    s = Sketch(theme, top=-1.6)
    s.half_plane()
    s.indenter(lambda x: 0.3 * (x + 0.3) ** 2 + 0.02, half_width=1.5, top=-1.05)
    s.arrow((0.15, -1.55), (0.15, -1.05), text="$P$", at=(0.32, -1.4))
    s.arrow((-0.25, -0.8), (0.35, -0.8), text="tilt", at=(0.05, -0.62))
    s.dimension(-1.0, 0.4, 0.3, "$x_1$ to $x_2$: unknown", s.blue)
    for end in (-1.0, 0.4):
        s.line([end] * 2, [-0.12, 0.4], s.blue, lw=0.8, ls=":")
    s.line([-0.3] * 2, [-0.08, 0.08])
    s.text(-0.3, -0.22, "$m$")
    return s.figure


def stress(theme):
    s = Sketch(theme, top=-0.9, bottom=1.6)
    s.half_plane()
    s.pressure(*hertz())
    s.text(-1.2, -0.4, "$p$", s.blue)
    for place in np.linspace(-0.7, 0.5, 4):
        s.arrow((place, 0.1), (place + 0.25, 0.1), s.red)
    s.text(1.0, 0.16, "$q$", s.red)
    box = np.array([0.55, 0.95, 0.95, 0.55, 0.55]), np.array([0.7, 0.7, 1.1, 1.1, 0.7])
    s.line(*box)
    s.arrow((0.95, 0.9), (1.4, 0.9), text="$\\sigma_{xx}$", at=(1.65, 0.9))
    s.arrow((0.55, 0.9), (0.1, 0.9))
    s.arrow((0.75, 1.1), (0.75, 1.45), text="$\\sigma_{yy}$", at=(1.0, 1.42))
    s.arrow((0.75, 0.7), (0.75, 0.4))
    s.arrow((1.05, 1.12), (1.05, 0.72), text="$\\sigma_{xy}$", at=(1.22, 0.6))
    s.text(-0.35, 0.85, "$z = x + iy$")
    return s.figure


def cattaneo(theme):
    s = Sketch(theme, top=-1.55)
    s.half_plane()
    x, p = hertz()
    stick = np.sqrt(np.maximum(0.36 - x**2, 0))
    s.line(x, -0.95 * p, s.ink, ls="--")
    s.line(x, -0.95 * (p - stick), s.red, lw=1.8)
    s.text(0.5, -1.05, "$f\\,p$")
    s.text(0.0, -0.22, "$q$", s.red)
    s.arrow((-2.1, -0.6), (-1.3, -0.6), s.red, text="$Q$", at=(-2.2, -0.78))
    s.arrow((0, -1.5), (0, -1.05), text="$P$", at=(0.17, -1.4))
    s.zones(0.6, 0.8)
    return s.figure


def spence(theme):
    s = Sketch(theme, top=-1.45)
    s.half_plane(label="soft")
    s.indenter(lambda x: 0.25 * np.maximum(np.abs(x) - 1.0, 0) ** 2 + 0.01, top=-0.95)
    s.text(1.2, -0.65, "stiff")
    s.arrow((0, -1.4), (0, -0.95), text="$P$", at=(0.17, -1.28))
    s.zones(0.55, 1.3)
    for sign in (-1, 1):
        s.arrow((1.0 * sign, 0.2), (0.6 * sign, 0.2), s.red)
    return s.figure


def patches(theme):
    s = Sketch(theme, top=-1.45)
    s.half_plane()
    s.indenter(lambda x: 0.22 * (1 - np.cos(2.6 * (np.abs(x) - 0.95))), 2.0, top=-0.95)
    s.arrow((0, -1.4), (0, -0.95), text="$P$", at=(0.17, -1.28))
    for k, centre in enumerate((-0.95, 0.95)):
        s.line([centre - 0.3, centre + 0.3], [0, 0], s.blue, lw=4)
        s.text(centre - 0.3, 0.2, f"$x_{2 * k + 1}$", s.blue)
        s.text(centre + 0.3, 0.2, f"$x_{2 * k + 2}$", s.blue)
    s.text(0, 0.2, "gap")
    return s.figure


def certificate(theme):
    s = Sketch(theme, top=-1.25, bottom=0.5, half_width=1.8)
    x, p = hertz()
    s.line([-1.5, 1.5], [0, 0])
    s.line(x, -p, s.blue)
    nodes = np.cos(np.pi * np.arange(1, 8) / 8)
    between = np.cos(np.pi * (np.arange(8) + 0.5) / 8)
    s.line(nodes, -np.sqrt(1 - nodes**2), s.blue, marker="o", ls="", ms=6)
    s.line(between, 0 * between, s.red, marker="x", ls="", ms=7)
    s.text(0, -0.6, "found here", s.blue)
    s.text(0.0, 0.25, "measured here", s.red)
    return s.figure


def cracks(theme):
    s = Sketch(theme, top=-1.4, bottom=1.2)
    s.half_plane()
    s.indenter(rounded, top=-0.95)
    s.arrow((0, -1.35), (0, -0.95), text="$P$", at=(0.17, -1.22))
    s.arrow((-0.55, -0.65), (0.05, -0.65), s.red, text="$Q$", at=(-0.7, -0.65))
    s.line([-0.75, -0.45], [0, 0], s.red, lw=4)
    s.line([-0.45, 0.75], [0, 0], s.blue, lw=4)
    s.dimension(-0.75, -0.45, 0.18, "$d$", s.red)
    s.arrow((-0.75, -0.2), (-0.2, -0.2), text="$s$", at=(-0.1, -0.2))
    s.line([-0.78, -0.75, -0.72], [0, 0.85, 0], s.ink, lw=1.8)
    s.arrow((-0.25, 0), (-0.25, 0.85), style="<|-|>", text="$a$", at=(-0.1, 0.45))
    for side in (-1, 1):
        s.arrow((-0.75 + 0.1 * side, 0.6), (-0.75 + 0.4 * side, 0.6))
    s.text(-1.5, 0.6, "$\\sigma(y)$")
    return s.figure


def derivatives(theme):
    s = Sketch(theme, top=-1.45, bottom=0.7)
    s.line([-1.8, 1.8], [0, 0])
    x, p = hertz()
    s.line(x, -p, s.blue)
    s.line(1.15 * x, -1.15 * p, s.blue, ls="--")
    inside = x[2:-2]
    s.line(inside, -0.16 / np.sqrt(1 - inside**2), s.red, lw=1.8)
    s.text(-0.45, -0.65, "$p$", s.blue)
    s.text(0.0, -0.33, "$\\delta p$", s.red)
    s.text(1.45, -0.85, "$P + \\delta P$", s.blue)
    for sign in (-1, 1):
        s.line([sign] * 2, [-0.1, 0.25], lw=0.8, ls=":")
        s.line([1.15 * sign] * 2, [-0.1, 0.25], lw=0.8, ls=":")
    s.arrow((1.0, 0.18), (1.15, 0.18), text="$\\delta b$", at=(1.08, 0.42))
    return s.figure


SKETCHES = {
    draw.__name__: draw
    for draw in (equation, gauss_chebyshev, kinks, edges, stress, cattaneo, spence, patches,
                 cracks, certificate, derivatives)
}  # fmt: skip


def draw_all(folder):
    Path(folder).mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(STYLE):
        for name, draw in SKETCHES.items():
            for theme in THEMES:
                path = Path(folder) / f"{name}-{theme}.svg"
                draw(theme).savefig(path, transparent=True, metadata={"Date": None})


if __name__ == "__main__":
    draw_all(sys.argv[1])
