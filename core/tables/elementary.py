"""Prints the polynomials of src/sampling's elementary functions; needs a Python with mpmath.

python tables/elementary.py"""

import sys

import mpmath as mp

mp.mp.dps = 50


def tell(*words):
    sys.stdout.write(" ".join(words) + "\n")


def show(name, f, low, high, degree):
    """Prints the polynomial through the Chebyshev points, whose largest error is close to the minimum. Constant term first."""
    coefficients, error = mp.chebyfit(f, [low, high], degree + 1, error=True)
    tell(f"{name}: within {mp.nstr(error, 2)}")
    for coefficient in coefficients[::-1]:
        tell(f"    {float(coefficient)!r},")


def series(term):
    """Returns a function by its series, for quotients by x that lose digits near 0."""
    return lambda x: mp.fsum(term(i) * x**i for i in range(60))


def scaled_complement(t):
    """Returns (1 + 2 x) exp(x^2) erfc(x) at t = (x - 4) / (x + 4)."""
    x = 4 * (1 + t) / (1 - t)
    return (1 + 2 * x) * mp.exp(x * x) * mp.erfc(x)


def show_parts(name, x, *digits):
    """Prints x as a sum of numbers with the given binary digits, and a double."""
    parts = []
    for count in digits:
        unit = mp.mpf(2) ** (mp.floor(mp.log(x, 2)) + 1 - count)
        parts.append(mp.floor(x / unit) * unit)
        x -= parts[-1]
    tell(f"{name}:", " + ".join(float(part).hex() for part in [*parts, x]))


def show_words(name, x, count):
    """Prints the binary digits after the point, 32 at a time."""
    mp.mp.dps = 400
    digits = int(mp.floor(x() * mp.mpf(2) ** (32 * count)))
    tell(f"{name}:", ", ".join(f"{digits >> 32 * (count - 1 - i) & 0xFFFFFFFF:#010x}" for i in range(count)))


def show_all():
    half = mp.log(2) / 2
    show("(exp(x) - 1 - x) / x^2", series(lambda i: 1 / mp.factorial(i + 2)), -half, half, 10)
    # s = f / (2 + f), at most the value for the square root of 2.
    s = mp.mpf("0.1715728752538099")
    show("(log((1 + s) / (1 - s)) / s - 2) / s^2, of s^2", series(lambda i: mp.mpf(2) / (2 * i + 3)), 0, s * s, 6)
    top = 2 / mp.sqrt(mp.pi)
    error_function = series(lambda i: top * (-1) ** i / (mp.factorial(i) * (2 * i + 1)))
    show("erf(x) / x - 1, of x^2", lambda z: error_function(z) - 1, 0, 1, 11)
    show("(1 + 2 x) exp(x^2) erfc(x), of (x - 4) / (x + 4)", scaled_complement, mp.mpf(-7) / 9, mp.mpf(3) / 4, 22)
    show_parts("log(2)", mp.log(2), 33)
    show_parts("1 / log(2)", 1 / mp.log(2))
    show_parts("pi / 2", mp.pi / 2, 33, 33)
    show_parts("pi / 2", mp.pi / 2, 53)
    show_words("2 / pi", lambda: 2 / mp.pi, 38)


if __name__ == "__main__":
    show_all()
