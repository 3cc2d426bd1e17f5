"""Prints the Chebyshev series of jaxhydro/waves/bessel.py to full double precision, ready to paste.

    python benchmarks/make_bessel_series.py

mpmath, which is no dependency of the project, is needed: have it in an environment of its own. Each function is
interpolated in 40 digits at more Chebyshev points than it needs terms, and the series is cut where its terms fall below
half a unit in the last place of a number of size one.
"""

import mpmath as mp

SWITCH = 8  # the series in x^2 below, in (8/x)^2 above
POINTS = 48
SMALL = mp.mpf(2) ** -56
mp.mp.dps = 40


def primes(x):
    """J1'(x), Y1'(x)."""
    return mp.besselj(1, x, derivative=1), mp.bessely(1, x, derivative=1)


def below_j(t):
    """J1', t = x^2 / 32 - 1."""
    return primes(mp.sqrt(32 * (t + 1)))[0]


def below_y(t):
    """x^2 (Y1' - 2/pi ln(x/2) J1'), t = x^2 / 32 - 1."""
    x = mp.sqrt(32 * (t + 1))
    j, y = primes(x)
    return x**2 * (y - 2 / mp.pi * mp.log(x / 2) * j)


def above(t):
    """R + i S = -i sqrt(pi x / 2) exp(-i (x - 3 pi/4)) (J1' + i Y1'), t = 2 (8/x)^2 - 1."""
    x = SWITCH / mp.sqrt((t + 1) / 2)
    j, y = primes(x)
    return -1j * mp.sqrt(mp.pi * x / 2) * mp.exp(-1j * (x - 3 * mp.pi / 4)) * mp.mpc(j, y)


def above_r(t):
    """R, even in 1/x."""
    return above(t).real


def above_s(t):
    """S x / 8: S is odd in 1/x."""
    return above(t).imag / mp.sqrt((t + 1) / 2)


def chebyshev(function):
    """Coefficients c_n of sum c_n T_n(t), c_0 whole."""
    angles = [mp.pi * (i + mp.mpf(1) / 2) / POINTS for i in range(POINTS)]
    values = [function(mp.cos(angle)) for angle in angles]
    terms = [2 * mp.fsum(v * mp.cos(n * a) for v, a in zip(values, angles)) / POINTS for n in range(POINTS)]
    terms[0] /= 2
    last = max(n for n in range(POINTS) if abs(terms[n]) > SMALL)
    return [float(term) for term in terms[: last + 1]]


if __name__ == "__main__":
    for name, function in {"BELOW_J": below_j, "BELOW_Y": below_y, "ABOVE_R": above_r, "ABOVE_S": above_s}.items():
        print(f"{name} = (")
        terms = [repr(term) for term in chebyshev(function)]
        for i in range(0, len(terms), 4):
            print("    " + ", ".join(terms[i : i + 4]) + ",")
        print(")")
