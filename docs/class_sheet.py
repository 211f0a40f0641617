"""A class sheet: numerical contact mechanics in four steps, as a marimo notebook.

    pip install -e ".[teach]" && marimo edit docs/class_sheet.py

The file is plain Python: hand it out, and let the class change it.
"""

import marimo

app = marimo.App(width="medium", app_title="Contact mechanics by computing")


@app.cell
def _():
    import marimo as mo
    import matplotlib.pyplot as plt
    import numpy as np
    import sie
    from sie import teaching

    return mo, np, plt, sie, teaching


@app.cell
def _(mo):
    mo.md(r"""
    # Contact mechanics by computing

    ## 1. An equation and fifty lines

    The pressure under a punch of slope $h'$ solves
    $\frac1\pi\,\mathrm{PV}\!\int p(\xi)/(x-\xi)\,d\xi = \frac{E^*}2h'(x)$. `teaching.solve` does
    it by Gauss-Chebyshev quadrature. **Question 1.** How many nodes does a parabola need? Why?
    """)


@app.cell
def _(mo):
    nodes = mo.ui.slider(2, 64, value=8, label="nodes n", show_value=True)
    shape = mo.ui.dropdown(["parabola", "rounded flat", "wedge"], value="parabola", label="punch")
    mo.hstack([nodes, shape])
    return nodes, shape


@app.cell
def _(nodes, np, plt, shape, sie, teaching):
    punch = {
        "parabola": sie.Parabola(1.0),
        "rounded flat": sie.RoundedFlat(0.5, 1.0),
        "wedge": sie.Wedge(1.0),
    }[shape.value]
    exact = sie.solve(sie.Scene(profile=punch, modulus=2.0, poisson=0.3, half_width=1.0))
    t, p, _ = teaching.solve(punch.slope, nodes.value, index=-1)
    x = np.linspace(-0.999, 0.999, 400)
    fig, ax = plt.subplots(layout="constrained")
    ax.plot(x, exact.pressure(x), label="exact")
    ax.plot(t, p, "o", label=f"{nodes.value} nodes")
    ax.set(xlabel="x/b", ylabel="pressure")
    ax.legend()
    fig
    return exact, punch


@app.cell
def _(mo):
    mo.md(r"""
    ## 2. How fast is it?

    **Question 2.** Which power of $n$ does the error follow for a punch with kinks, and for a
    wedge? What does a factor of ten in accuracy cost if the system is solved in $n^3$ operations?
    """)


@app.cell
def _(exact, np, plt, punch, teaching):
    counts = 2 ** np.arange(2, 9)

    def largest_error(n):
        t, p, _ = teaching.solve(punch.slope, int(n), index=-1)
        seen = np.abs(t) > 0.05  # the pressure of a wedge is infinite at 0
        return np.abs(p - exact.pressure(t))[seen].max() / exact.pressure(t)[seen].max()

    errors = [largest_error(n) for n in counts]
    fig_2, ax_2 = plt.subplots(layout="constrained")
    ax_2.loglog(counts, errors, "o-")
    ax_2.set(xlabel="nodes n", ylabel="error of p over its peak")
    fig_2
    return


@app.cell
def _(mo):
    mo.md(r"""
    ## 3. Where are the edges?

    `teaching.solve` returns a *misfit*: it is zero where the edges are right. **Question 3.** A
    parabola $h = x^2/2$ is tilted by $0.2\,x$. Where does the contact of half-width 1 lie? Find the
    zero of the misfit over the centre $m$, and compare with `sie`.
    """)


@app.cell
def _(mo, np, sie, teaching):
    centres = np.linspace(-0.5, 0.5, 11)
    misfits = [
        teaching.solve(lambda s, m=m: (m + s) + 0.2, n=8, index=-1)[2] for m in centres.tolist()
    ]
    by_misfit = float(np.interp(0.0, misfits, centres))
    tilted = sie.solve(
        sie.Scene(profile=sie.Parabola(1.0), modulus=2.0, poisson=0.3, half_width=1.0, tilt=0.2)
    )
    mo.md(f"centre by the misfit {by_misfit:.12f}, by `sie` {tilted.centre:.12f}")
    return by_misfit, tilted


@app.cell
def _(mo):
    mo.md(r"""
    ## 4. Stick and slip

    The shear in partial slip is $f\,(p - \hat p)$, and $\hat p$ is the pressure of the *same punch*
    under $P - Q/f$. **Question 4.** Show it with two calls of `sie.solve`, for a punch of your own,
    and sketch the fretting loop.
    """)


@app.cell
def _(mo):
    share = mo.ui.slider(0.0, 0.99, step=0.01, value=0.6, label="Q/(f P)", show_value=True)
    share
    return (share,)


@app.cell
def _(np, plt, punch, share, sie):
    f = 0.5
    pressed = sie.solve(
        sie.Scene(profile=punch, modulus=2.0, poisson=0.3, normal_load=1.0, friction=f)
    )
    pushed = pressed.with_(tangential_load=share.value * f)
    smaller = pressed.with_(normal_load=1.0 - share.value)
    places = np.linspace(*pressed.edges, 400)[1:-1]
    fig_4, ax_4 = plt.subplots(layout="constrained")
    ax_4.plot(places, f * pressed.pressure(places), "k--", label="f p")
    ax_4.plot(places, pushed.shear(places), label="q of sie")
    by_hand = f * (pressed.pressure(places) - smaller.pressure(places))
    ax_4.plot(places, by_hand, ":", label="by hand")
    ax_4.set(xlabel="x", ylabel="shear")
    ax_4.legend()
    fig_4
    return


if __name__ == "__main__":
    app.run()
