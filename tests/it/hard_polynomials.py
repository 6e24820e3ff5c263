"""Writes hard_polynomials.txt: python3 hard_polynomials.py > hard_polynomials.txt (mpmath 1.3, sympy 1.14).

Truth by another route than the program's: sympy splits the exact polynomial into irreducible factors, which gives the
multiplicities; Aberth's iteration and Newton's find their roots with as many of mpmath's digits as it takes for each
part to have 60; Sturm's theorem counts, exactly, how many roots are real and how many imaginary, and that many parts are set
to zero. Discs of radius n |p/p'|, each of which holds a root, must be apart from one another.
"""

import random
from fractions import Fraction as F
from math import comb, factorial

import mpmath as mp
import sympy as sp

S = sp.Symbol("s")
DIGITS = 60
rows = []


def dec(x):
    """A rational with a finite decimal expansion, exactly."""
    x = F(x)
    if x.denominator == 1:
        n = str(abs(x.numerator))
        short = n.rstrip("0")
        zeros = len(n) - len(short)
        text = f"{short}e{zeros}" if zeros > 5 else n
    else:
        places = next(k for k in range(1, 2000) if 10**k % x.denominator == 0)
        n = str(abs(x.numerator) * 10**places // x.denominator)
        text = f"{n}e-{places}" if len(n) < places - 3 else f"{n.zfill(places + 1)[:-places]}.{n.zfill(places + 1)[-places:]}"
    return ("-" if x < 0 else "") + text


def product(*factors):
    """Factors as (coefficients, power), or coefficients alone."""
    return [f if isinstance(f[0], (tuple, list)) else (f, 1) for f in factors]


def expand(factors):
    p = [F(1)]
    for c, k in product(*factors):
        for _ in range(k):
            q = [F(0)] * (len(p) + len(c) - 1)
            for i, a in enumerate(p):
                for j, b in enumerate(c):
                    q[i + j] += a * F(b)
            p = q
    return p


def text(factors):
    if len(factors) == 1 and factors[0][1] == 1:
        return " ".join(map(dec, factors[0][0]))
    return " ".join(f"({' '.join(map(dec, c))})" + (f"^{k}" if k > 1 else "") for c, k in factors)


def sympy_poly(p):
    return sp.Poly([sp.Rational(F(c).numerator, F(c).denominator) for c in p], S, domain="QQ")


def integer_poly(expression):
    return [int(c) for c in sp.Poly(expression, S, domain="QQ").clear_denoms()[1].all_coeffs()]


def count_imaginary(p):
    """Roots of an irreducible factor on the imaginary axis: all it shares with its mirror image, counted on x = -s^2."""
    mirror = sp.Poly(p.as_expr().subs(S, -S), S, domain="QQ")
    g = sp.gcd(p, mirror)
    if g.degree() == 0:
        return 0
    c = g.all_coeffs()[::-1]
    if any(c[1::2]):
        assert g.degree() == 1 and c[0] == 0, g
        return 1
    in_x = sp.Poly([a * (-1) ** k for k, a in enumerate(c[0::2])][::-1], S, domain="QQ")
    return 2 * in_x.count_roots(0, None)


def start(m):
    """Circles as wide as the roots are large, from the upper convex hull of (k, log |c_k|)."""
    hull = []
    for k, a in enumerate(reversed(m)):
        if a == 0:
            continue
        at = (k, mp.log(abs(a)))
        slope = lambda a, b: (b[1] - a[1]) / (b[0] - a[0])
        while len(hull) > 1 and slope(hull[-2], hull[-1]) <= slope(hull[-1], at):
            hull.pop()
        hull.append(at)
    points = []
    for a, b in zip(hull, hull[1:]):
        n, radius = b[0] - a[0], mp.exp((a[1] - b[1]) / (b[0] - a[0]))
        points += [radius * mp.expj(2 * mp.pi * j / n + 0.7 + a[0]) for j in range(n)]
    return points


def aberth(m, z):
    slope = [a * (len(m) - 1 - i) for i, a in enumerate(m[:-1])]
    active = set(range(len(z)))
    for _ in range(3000):
        for i in sorted(active):
            newton = mp.polyval(m, z[i]) / mp.polyval(slope, z[i])
            step = newton / (1 - newton * mp.fsum(1 / (z[i] - w) for j, w in enumerate(z) if j != i))
            z[i] -= step
            if abs(step) < mp.mpf(10) ** -(0.45 * mp.mp.dps) * abs(z[i]):
                active.discard(i)
        if not active:
            break
    else:
        raise ArithmeticError("not settled")
    for _ in range(2):
        z = [w - mp.polyval(m, w) / mp.polyval(slope, w) for w in z]
    return z


def simple_roots(p):
    n = p.degree()
    c = [sp.Rational(a) for a in p.all_coeffs()]
    if n == 1:
        return [(F(int((-c[1] / c[0]).p), int((-c[1] / c[0]).q)), F(0))]
    real, imaginary = p.count_roots(), count_imaginary(p)
    # s = 10^k z with the geometric mean of the roots near 1.
    k = int(mp.nint(mp.log10(abs(mp.mpf(int(c[-1].p)) / int(c[-1].q) * int(c[0].q) / int(c[0].p))) / n))
    c = [a * sp.Rational(10) ** (k * (n - i)) for i, a in enumerate(c)]
    for dps in (150, 300, 600, 1200):
        mp.mp.dps = dps
        m = [mp.mpf(int(a.p)) / int(a.q) for a in c]
        try:
            found = aberth(m, start(m))
        except ArithmeticError:
            continue
        slope = [a * (n - i) for i, a in enumerate(m[:-1])]
        error = [n * abs(mp.polyval(m, z) / mp.polyval(slope, z)) for z in found]
        apart = all(abs(a - b) > 4 * (error[i] + error[j]) for i, a in enumerate(found) for j, b in enumerate(found[:i]))
        parts = sorted((abs(z.imag), i) for i, z in enumerate(found))
        on_real = {i for _, i in parts[:real]}
        parts = sorted((abs(z.real), i) for i, z in enumerate(found))
        on_imaginary = {i for _, i in parts[:imaginary]}
        z = [mp.mpc(0 if i in on_imaginary else z.real, 0 if i in on_real else z.imag) for i, z in enumerate(found)]
        good = lambda part, e: part == 0 or e < mp.mpf(10) ** -(DIGITS + 5) * abs(part)
        snapped = all(abs(found[i] - z[i]) <= 2 * error[i] + mp.mpf(10) ** (10 - dps) * abs(z[i]) for i in range(n))
        if apart and snapped and all(good(a.real, e) and good(a.imag, e) for a, e in zip(z, error)):
            return [(a.real * mp.mpf(10) ** k, a.imag * mp.mpf(10) ** k) for a in z]
    raise ValueError("no digits")


def shown(x):
    """60 digits; a finite decimal exactly."""
    if isinstance(x, F):
        if any(10**k % x.denominator == 0 for k in range(201)):
            return dec(x)
        mp.mp.dps = DIGITS + 40
        x = mp.mpf(x.numerator) / x.denominator
    if x == 0:
        return "0"
    mp.mp.dps = max(mp.mp.dps, DIGITS + 20)
    text = mp.nstr(x, DIGITS, strip_zeros=True, min_fixed=-5, max_fixed=20)
    return text[:-2] if text.endswith(".0") else text.replace(".0e", "e")


def row(name, source, *factors, num=None, refused=None):
    factors = product(*factors)
    p = sympy_poly(expand(factors))
    lines = [f"[{name}]", f"source: {source}", f"p: {text(factors)}"]
    if num is not None:
        num = product(*num)
        q = sympy_poly(expand(num))
        shared = sp.gcd(p, q)
        lines += [f"num: {text(num)}", f"cancels: {shared.degree()}"]
        p = sp.quo(p, shared)
    roots = []
    for factor, multiplicity in sp.factor_list(p)[1]:
        roots += [(re, im, multiplicity) for re, im in simple_roots(factor)]
    assert sum(m for _, _, m in roots) == p.degree(), name
    right = sum(m for re, _, m in roots if re > 0)
    axis = max([m for re, _, m in roots if re == 0], default=0)
    verdict = "unstable" if right or axis > 1 else "marginally_stable" if axis else "asymptotically_stable"
    lines += [f"stability: {verdict}", f"right: {right}"]
    if refused:
        lines.append(f"refused: {refused}")
    else:
        mp.mp.dps = 100
        as_float = lambda x: mp.mpf(x.numerator) / x.denominator if isinstance(x, F) else x
        upper = [(re, im, m) for re, im, m in roots if im >= 0]
        upper.sort(key=lambda r: (-as_float(r[0]), as_float(r[1])))
        lines += [f"{m} {shown(re)} {shown(im)}" for re, im, m in upper]
    rows.append("\n".join(lines))
    import sys
    print(name, len(rows), file=sys.stderr)


def line(*roots):
    """Factors s - r."""
    return [(1, -F(r)) for r in roots]


def pair(re, im):
    re, im = F(re), F(im)
    return (1, -2 * re, re * re + im * im)


def orthogonal(f, n):
    return integer_poly(f(n, S))


WHOLE = "constructed"

# Wilkinson
wilkinson = "Wilkinson, Rounding Errors in Algebraic Processes, 1963, ch. 2"
row("Wilkinson 10", wilkinson, *line(*range(-10, 0)))
row("Wilkinson 20", wilkinson, *line(*range(-20, 0)))
row("Wilkinson 20, multiplied out, its roots on the right", wilkinson, expand(product(*line(*range(1, 21)))))
perturbed = expand(product(*line(*range(1, 21))))
perturbed[1] -= F(1, 2**23)
row("Wilkinson 20, perturbed by 2^-23", wilkinson, perturbed)
perturbed = expand(product(*line(*range(-20, 0))))
perturbed[1] += F(1, 2**23)
row("the same on the left", wilkinson, perturbed)
row("Wilkinson 20 in powers of 1/2", wilkinson, expand(product(*line(*[-F(1, 2**k) for k in range(1, 21)]))))
row("Wilkinson 50", WHOLE, *line(*range(-50, 0)))

# Multiplicity
row("(s + 1)^10", WHOLE, expand([((1, 1), 10)]))
row("(s + 1)^50", WHOLE, ((1, 1), 50))
row("(s - 1)^10", WHOLE, ((1, -1), 10))
row("(3s + 1)^7: a root no decimal holds", WHOLE, expand([((3, 1), 7)]))
row("(s + 0.1)^10", WHOLE, expand([((1, F("0.1")), 10)]))
row("(s + 1)^10 (s + 2)^5", WHOLE, expand([((1, 1), 10), ((1, 2), 5)]))
row("(s + 1)^k (s + 2)^m (s + 3)^n (s + 4)", WHOLE, ((1, 1), 7), ((1, 2), 5), ((1, 3), 3), (1, 4))
row("(s + 1)^10 (s - 2)^6 s^4", WHOLE, ((1, 1), 10), ((1, -2), 6), ((1, 0), 4))
row("(s^2 + s + 1)^5 (s + 1)^3", WHOLE, ((1, 1, 1), 5), ((1, 1), 3))
row("(s^3 + s + 1)^4 (s^2 + 3s + 1)^6", WHOLE, expand([((1, 0, 1, 1), 4), ((1, 3, 1), 6)]))
row("multiplicities 1 to 8 side by side", WHOLE, *[((1, F(k, 10)), k) for k in range(1, 9)])
for k in (10, 20, 40):
    p = expand([((1, 1), 10)])
    p[-1] += F(1, 10**k)
    row(f"(s + 1)^10 + 1e-{k}", "constructed; the ten roots stand on a small circle", p)
row("(s + 1)^2 - 1e-60", WHOLE, (1, 2, 1 - F(1, 10**60)))
row("(s + 1)^2 + 1e-60", WHOLE, (1, 2, 1 + F(1, 10**60)))

# Families
oeis = "classical orthogonal polynomials, sympy"
row("Chebyshev T10", oeis, orthogonal(sp.chebyshevt_poly, 10))
row("Chebyshev T20", oeis, orthogonal(sp.chebyshevt_poly, 20))
row("Chebyshev T50", oeis, orthogonal(sp.chebyshevt_poly, 50))
row("Chebyshev T20(2s + 1)", oeis + "; all roots in (-1, 0)", integer_poly(sp.chebyshevt_poly(20, S).subs(S, 2 * S + 1)))
row("Legendre P10", oeis, orthogonal(sp.legendre_poly, 10))
row("Legendre P30", oeis, orthogonal(sp.legendre_poly, 30))
row("Hermite H40", oeis, orthogonal(sp.hermite_poly, 40))
row("Laguerre L20(-s)", oeis, integer_poly(sp.laguerre_poly(20, S).subs(S, -S)))
bessel = lambda n: [factorial(2 * n - k) // (2 ** (n - k) * factorial(k) * factorial(n - k)) for k in range(n, -1, -1)]
row("Bessel filter of order 10", "Thomson, Proc. IEE 96, 1949", bessel(10))
row("Bessel filter of order 50", "Thomson, Proc. IEE 96, 1949", bessel(50))
row("exponential series to s^20", "Szego, 1924: the zeros lie near a curve of his", [factorial(20) // factorial(k) for k in range(20, -1, -1)])
row("exponential series to s^50", "Szego, 1924", [factorial(50) // factorial(k) for k in range(50, -1, -1)])
row("Pade of order 12 for a dead time of 1 s", "Golub and Van Loan, Matrix Computations, Pade approximants of exp", [F(factorial(24 - k) * factorial(12), factorial(12 - k) * factorial(k)) for k in range(12, -1, -1)])

# Random
for seed, n, size in [(1, 8, 9), (2, 15, 9), (3, 20, 10**6), (4, 30, 9), (5, 40, 1000), (6, 50, 9), (7, 50, 10**9)]:
    draw = random.Random(seed)
    p = [draw.randint(-size, size) or 1 for _ in range(n + 1)]
    row(f"random of degree {n}, coefficients within {size}", f"Python's random.Random({seed}).randint", p)
draw = random.Random(8)
row("random of degree 50, one coefficient in five", "Python's random.Random(8)", [1] + [draw.choice([0, 0, 0, 0, draw.randint(-9, 9)]) for _ in range(49)] + [3])
draw = random.Random(9)
row("random damped pairs, multiplied out, degree 24", "Python's random.Random(9)", expand(product(*[pair(-F(draw.randint(1, 99), 100), F(draw.randint(1, 999), 100)) for _ in range(12)])))

# Sizes
ten = lambda k: F(10) ** k
row("roots -1e-12 to -1e12, every third power", WHOLE, expand(product(*line(*[-ten(k) for k in range(-12, 13, 3)]))))
row("roots -1e-12 to -1e12, every power", WHOLE, *line(*[-ten(k) for k in range(-12, 13)]))
row("the same on both sides", WHOLE, *line(*[F(-1) ** k * ten(k) for k in range(-12, 13)]))
row("the nearest floating-point numbers to them", "constructed; found without any error", *line(*[F((-1) ** abs(k) * float(f"1e{k}")) for k in range(-12, 13)]))
row("pairs of 1e-12 to 1e12 rad/s, damping 0.1", WHOLE, *[(1, ten(k) / 5, ten(2 * k)) for k in range(-12, 13, 4)])
row("pairs of 1e-12 to 1e12 rad/s, damping 1e-12", WHOLE, *[(1, 2 * ten(k - 12), ten(2 * k)) for k in range(-12, 13, 6)])
row("coefficients 1e-12 to 1e12", WHOLE, (ten(-12), 1, ten(12), 1, ten(-12)))
row("coefficients 1e12 and 1e-12 by turns", WHOLE, [ten(12 if k % 2 else -12) for k in range(21)])
draw = random.Random(10)
row("degree 20, coefficients 1e-12 to 1e12 at random", "Python's random.Random(10)", [draw.randint(1, 9) * ten(draw.randint(-12, 12)) for _ in range(21)])
draw = random.Random(11)
row("degree 50, coefficients 1e-12 to 1e12 at random", "Python's random.Random(11)", [draw.choice([-1, 1]) * draw.randint(1, 9) * ten(draw.randint(-12, 12)) for _ in range(51)])
row("RLC in SI units: 1 kohm, 1 mH, 1 pF, and a slow pole", WHOLE, expand(product((1, 10**6, 10**15), (1, F("0.02")))))
row("roots 1e-150 and 1e150", WHOLE, (1, ten(150), 1))
jt = "after Jenkins and Traub, ACM TOMS 1, 1975, "
row("p1: (s - A)(s + A)(s - 1), A = 1e12", jt + "test 1", *line(ten(12), -ten(12), 1))
row("p4", jt + "test 4", expand(product(((1, F("-0.1")), 3), *line("0.5", "0.6", "0.7"))))
row("p5", jt + "test 5", expand(product(((1, F("-0.1")), 4), ((1, F("-0.2")), 3), ((1, F("-0.3")), 2), (1, F("-0.4")))))
row("p6", jt + "test 6", expand(product(*line("0.1", "1.001", "0.998", "1.00002", "0.99999"))))
row("p7, a = 1e-10", jt + "test 7", *line("0.001", "0.01", "0.1", 1, -10), pair("0.1", ten(-10)))
row("p9", jt + "test 9", (1,) + (0,) * 9 + (-ten(-20),), (1,) + (0,) * 9 + (ten(20),))
row("p10, A = 1e12", jt + "test 10", *line(ten(12), 1, ten(-12)))

# On the imaginary axis
row("a simple pair", WHOLE, (1, 0, 1))
row("a double pair", WHOLE, expand([((1, 0, 1), 2)]))
row("a pair five times", WHOLE, expand([((1, 0, 1), 5)]))
row("two pairs", WHOLE, expand(product((1, 0, 1), (1, 0, 4))))
row("a double pair at sqrt 2 and a decay", WHOLE, expand([((1, 0, 2), 2), ((1, 3), 1)]))
row("s^4 + 5s^2 + 3: two pairs no fraction holds", WHOLE, (1, 0, 5, 0, 3))
row("the same squared", WHOLE, expand([((1, 0, 5, 0, 3), 2)]))
row("a pair and an integrator", WHOLE, (1, 0, 1), (1, 0))
row("a double pair and a double integrator", WHOLE, ((1, 0, 1), 2), ((1, 0), 2))
row("ten integrators", WHOLE, [1] + [0] * 10)
row("pairs at 1e-6 and 1e6", WHOLE, expand(product((1, 0, ten(-12)), (1, 0, ten(12)))))
row("two pairs 1e-12 apart are simple", WHOLE, expand(product((1, 0, 1), (1, 0, 1 + ten(-12)))))
row("two pairs 1e-40 apart are simple", WHOLE, expand(product((1, 0, 1), (1, 0, 1 + ten(-40)))))
row("ten pairs", WHOLE, *[(1, 0, k) for k in range(1, 11)])
row("symmetric about both axes", WHOLE, (1, 0, 1, 0, 1))
row("pairs, mirrored real roots and a quadruple", WHOLE, expand(product((1, 0, 7), (1, 0, -3), (1, 0, 0, 0, 4), (1, 1))))
for k in (9, 15, 30, 100):
    for sign, side in ((-1, "left"), (1, "right")):
        row(f"a pair 1e-{k} to the {side}", WHOLE, (1, -2 * sign * ten(-k), 1 + ten(-2 * k)))
row("pairs 1e-15 left and on the axis", WHOLE, expand(product(pair(-ten(-15), 1), (1, 0, 1))))
row("pairs 1e-15 left, on the axis and right", WHOLE, expand(product(pair(-ten(-15), 1), (1, 0, 1), pair(ten(-15), 1))))
row("a double pair 1e-15 to the left", WHOLE, expand([(pair(-ten(-15), 1), 2)]))
row("a pair 1e-9 to the right among (s + 1)^10", WHOLE, expand([((1, 1), 10), (pair(ten(-9), 1), 1)]))
row("a real root 1e-15 to the right", WHOLE, expand(product(*line(ten(-15), -1, -2))))
row("a real root 1e-200 to the left", WHOLE, (1, 1 + ten(-200), ten(-200)))

# Clusters
row("1 and 1 +- 1e-8", WHOLE, expand(product(*line(-1, -1 - ten(-8), -1 + ten(-8)))))
row("1 and 1 +- 1e-8, twice each", WHOLE, *[(f, 2) for f in line(-1, -1 - ten(-8), -1 + ten(-8))])
row("ten roots 1e-12 apart", WHOLE, expand(product(*line(*[-1 - k * ten(-12) for k in range(10)]))))
row("five roots 1e-30 apart", WHOLE, *line(*[-1 - k * ten(-30) for k in range(5)]))
row("four pairs 1e-10 apart", WHOLE, expand(product(*[pair(-1, 1 + k * ten(-10)) for k in range(4)])))
row("a cluster at 1e6 and one at 1e-6", WHOLE, expand(product(*line(*[-ten(6) - k * ten(-6) for k in range(3)], *[-ten(-6) - k * ten(-18) for k in range(3)]))))
mignotte = "Mignotte, Some useful bounds, 1982: s^n - 2(as - 1)^2"
def close_pair(n, a):
    p = [F(0)] * (n + 1)
    p[0] = F(1)
    p[-3:] = [p[-3] - 2 * a * a, F(4 * a), F(-2)]
    return p
row("Mignotte 10, a = 1000", mignotte, close_pair(10, 1000))
row("Mignotte 20, a = 100", mignotte, close_pair(20, 100))
row("Mignotte 31, a = -1000000", mignotte, close_pair(31, -(10**6)))
row("Mignotte 50, a = 10", mignotte, close_pair(50, 10))
row("Mignotte 50, a = 1e12", mignotte + "; the two agree in 312 digits", close_pair(50, 10**12))

# Symmetric, cyclotomic
row("Lehmer", "Lehmer, Ann. of Math. 34, 1933", (1, 1, 0, -1, -1, -1, -1, -1, 0, 1, 1))
for seed, n in [(12, 20), (13, 40)]:
    draw = random.Random(seed)
    half = [draw.randint(-99, 99) or 1 for _ in range(n // 2)]
    row(f"palindromic of degree {n}", f"Python's random.Random({seed})", half + [draw.randint(-99, 99)] + half[::-1])
draw = random.Random(14)
even = [1] + [draw.randint(-50, 50) for _ in range(15)]
row("even of degree 30", "Python's random.Random(14)", [c for a in even for c in (a, 0)][:-1])
row("cyclotomic 60", "sympy", integer_poly(sp.cyclotomic_poly(60, S)))
row("cyclotomic 105", "sympy", integer_poly(sp.cyclotomic_poly(105, S)))
row("s^50 - 1", WHOLE, [1] + [0] * 49 + [-1])
row("s^50 + 1", WHOLE, [1] + [0] * 49 + [1])
row("1 + s + ... + s^52", WHOLE, [1] * 53)

# Special rows of the Routh array
nise = "Nise, Control Systems Engineering, example "
row("Nise 6.1", nise + "6.1", (1, 10, 31, 1030))
row("Nise 6.2: zero in the first column", nise + "6.2", (1, 2, 3, 6, 5, 3))
row("Nise 6.4: a row of zeros", nise + "6.4", (1, 7, 6, 42, 8, 56))
row("Nise 6.5: a row of zeros, degree 8", nise + "6.5", (1, 1, 12, 22, 39, 59, 48, 38, 20))
ogata = "Ogata, Modern Control Engineering, Routh's criterion, special cases"
row("Ogata: zero in the first column", ogata, (1, 2, 1, 2))
row("Ogata: a row of zeros", ogata, (1, 2, 24, 48, -25, -50))
row("zero in the first column, degree 5", "Dorf and Bishop, Modern Control Systems, section 6.2", (1, 2, 2, 4, 11, 10))
row("third row starts with zero", WHOLE, (1, 1, 1, 1, 1))
row("third row starts with zero, degree 6", WHOLE, (1, 1, 1, 1, 2, 3, 1))
row("two rows of zeros", WHOLE, expand(product(((1, 0, 1), 2), (1, 1), (1, 2))))
row("three rows of zeros", WHOLE, expand(product(((1, 0, 3), 3), ((1, 1, 1), 2))))
row("a row of zeros with its pair on the right as well", WHOLE, expand(product((1, 0, 1), (1, 0, -1), (1, -1, 1), (1, 2))))
row("only the two ends", WHOLE, (1, 0, 0, 0, 0, 7))
row("on the edge", "constructed: stable for k < 6", (1, 2, 3, 6))
row("1e-20 inside the edge", "constructed", (1, 2, 3, 6 - ten(-20)))
row("1e-20 outside the edge", "constructed", (1, 2, 3, 6 + ten(-20)))
row("every other coefficient zero", WHOLE, (1, 0, 3, 0, 3, 0, 2))

# What cancels
row("a pole 1e-12 from a zero stays", WHOLE, (1, 1), (1, 2), num=[(1, 1 + ten(-12))])
row("a pole 1e-100 from a zero on the right stays", WHOLE, (1, -1), (1, 2), num=[(1, -1 + ten(-100))])
row("the same pole and zero on the right cancel", WHOLE, expand(product((1, -1), (1, 2))), num=[(2, -2)])
row("one of a double pole cancels", WHOLE, expand([((1, 1), 2), ((1, 3), 1)]), num=[expand(product((1, 1), (1, 5)))])
row("a double pair becomes simple", WHOLE, expand([((1, 0, 2), 2)]), num=[(3, 0, 6)])
row("a double pair does not, 1e-30 beside it", WHOLE, expand([((1, 0, 2), 2)]), num=[(1, 0, 2 + ten(-30))])
row("an uncancelled s", WHOLE, (1, 3, 2, 0), num=[(5, 0)])
row("half of Wilkinson 20 cancels", WHOLE, expand(product(*line(*range(-20, 0)))), num=[expand(product(*line(*range(-10, 0))))])
shared = [random.Random(15).randint(-9, 9) or 1 for _ in range(26)]
draw = random.Random(15)
shared, over, under = ([draw.randint(-9, 9) or 1 for _ in range(n)] for n in (26, 15, 16))
row("a factor of degree 25 is shared", "Python's random.Random(15)", expand(product(shared, under)), num=[expand(product(shared, over))])
nearly = expand(product(shared, over))
nearly[-1] += 1
row("nothing is, one unit beside it", "Python's random.Random(15)", expand(product(shared, under)), num=[nearly])
row("improper, and something cancels", WHOLE, (1, 3, 2), num=[expand(product((1, 1), (1, 0, 4)))])
row("improper: all of the denominator cancels", WHOLE, (1, 3, 2), num=[expand(product((1, 3, 2), (1, 0, -4)))])

# Labs
row("hanging pendulum on a cart", "labs/ee361-lab3, exact decimals of its denominator", [F(t) for t in "0.0132 0.0024 0.41202 0.05886".split()])
row("upright pendulum on a cart", "labs/ee361-lab3, exact decimals of its denominator", [F(t) for t in "0.0132 0.0024 -0.41202 -0.05886".split()])

# Beyond f64
row("a root of 1e350", WHOLE, (1, ten(350), 1), refused="OutOfRange")
row("a pair 1e-350 to the left", WHOLE, (1, 2 * ten(-350), 1), refused="OutOfRange")

print(f"""# Polynomials that are hard to find roots of, or to decide on. Written by hard_polynomials.py, which says how.
#
# p        highest power first, exactly; (…)^n are factors to be multiplied out
# num      a numerator over p; what follows is then about the denominator after cancelling
# cancels  the degree of what numerator and denominator share
# right    roots in the right half-plane, by multiplicity
# refused  the error wanted in place of roots
# the rest: multiplicity, real part, imaginary part of each root on or above the real axis, to {DIGITS} digits
""")
print("\n\n".join(rows))
