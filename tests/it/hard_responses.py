"""Writes hard_responses.txt: python3 hard_responses.py > hard_responses.txt (mpmath 1.3).

Truth by another route than the program's: the Taylor series of the response about t = 0, whose coefficients follow exactly from
those of the transfer function by long division, summed with as many digits as its largest term has, and 60 more. Where poles are
so far apart that this would not end, partial fractions with given real poles and 400 digits.
"""

from fractions import Fraction as F

import mpmath as mp

mp.mp.dps = 60


def numbers(text):
    return [F(word) for word in text.split()]


def multiplied_out(text):
    """`1 2 3` or `(1 1)^10 (1 2)`, highest power first."""
    if not text.startswith("("):
        return numbers(text)
    result = [F(1)]
    for factor in text.split("(")[1:]:
        inside, power = factor.split(")")
        power = int(power.strip()[1:] or 1) if power.strip() else 1
        for _ in range(power):
            p = numbers(inside)
            new = [F(0)] * (len(result) + len(p) - 1)
            for i, a in enumerate(result):
                for j, b in enumerate(p):
                    new[i + j] += a * b
            result = new
    return result


def by_taylor(num, den, kind, t):
    if kind == "step":
        den = den + [F(0)]
    n = len(den) - 1
    b = [F(0)] * (n + 1 - len(num)) + num
    size = max(abs(c) for c in den)
    speed = float(2 * max(abs(c / den[0]) ** F(1, 1) if k == 1 else float(abs(c / den[0])) ** (1 / k) for k, c in enumerate(den) if k))
    digits = int(60 + 0.9 * speed * float(t) + 30)
    with mp.workdps(digits):
        a = [mp.mpf(c.numerator) / c.denominator for c in den]
        bb = [mp.mpf(c.numerator) / c.denominator for c in b]
        t = mp.mpf(t)
        # y = sum of m[k] t^k / k!, where m are the Markov parameters from 1/s on.
        markov = []
        total, power = mp.mpf(0), mp.mpf(1)
        k = 0
        while True:
            value = bb[k + 1] if k + 1 <= n else mp.mpf(0)
            for j in range(1, min(k, n) + 1):
                value -= a[j] * markov[k - j]
            value /= a[0]
            markov.append(value)
            term = value * power
            total += term
            k += 1
            power = power * t / k
            if k > n + 10 and k > 2.8 * speed * float(t) + 60 and abs(term) < mp.mpf(10) ** (-60) * (abs(total) + mp.mpf(10) ** (-200)):
                return +total
            if k > 200000:
                raise SystemExit("too many terms")


def by_real_poles(num, lead, poles, kind, t):
    """Distinct real poles of a denominator that begins with `lead`."""
    poles = [F(p) for p in poles.split()] + ([F(0)] if kind == "step" else [])
    with mp.workdps(400):
        total = mp.mpf(0)
        for p in poles:
            value = F(0)
            for c in num:
                value = value * p + c
            for q in poles:
                if q != p:
                    value /= p - q
            total += mp.mpf(value.numerator) / value.denominator * mp.exp(mp.mpf(p.numerator) / p.denominator * mp.mpf(t))
        return +total / (mp.mpf(lead.numerator) / lead.denominator)


def entry(name, num, den, kind, times, shape, final="none", accuracy="1e-12", poles=None):
    top, bottom = multiplied_out(num), multiplied_out(den)
    if final == "exact":
        final = mp.nstr(mp.mpf(top[-1].numerator) / top[-1].denominator * bottom[-1].denominator / bottom[-1].numerator, 20)
    print(f"[{name}]")
    print(f"num: {num}")
    print(f"den: {den}")
    print(f"kind: {kind}")
    print(f"shape: {shape}")
    print(f"final: {final}")
    print(f"accuracy: {accuracy}")
    for t in times.split():
        y = by_real_poles(top, bottom[0], poles, kind, t) if poles else by_taylor(top, bottom, kind, t)
        print(t, mp.nstr(y, 30))
    print()


print("""# Responses that are hard to compute: terms that cancel, and times that lie far apart. Written by hard_responses.py, which says how.
#
# num, den  highest power first, exactly; (...)^n are factors to be multiplied out
# kind      impulse or step
# final     the final value, or none
# accuracy  demanded of each value, as a part of the largest value in the list
# the rest: t in s and y(t)
""")

decay, swings, growth = "exponential_decay", "decaying_oscillation", "exponential_growth"
near = "0.25 1 2 5 10 30"
entry("a pair 1e-30 apart", "1", "1 2 1.000000000000000000000000000000000000000000000000000000000001", "impulse", near, decay, "0")
entry("a pair 1e-30 apart, step", "1", "1 2 1.000000000000000000000000000000000000000000000000000000000001", "step", near, decay, "exact")
entry("two real poles 2e-30 apart", "1", "1 2 0.999999999999999999999999999999999999999999999999999999999999", "impulse", near, decay, "0")
entry("two real poles 2e-9 apart", "1", "(1 1.000000001) (1 0.999999999)", "step", near, decay, "exact")
entry("three poles 1e-20 apart", "1 3", "(1 1) (1 1.00000000000000000001) (1 1.00000000000000000002)", "impulse", near, decay, "0")
entry("ten poles 1e-12 apart", "1", " ".join(f"(1 1.00000000000{k})" for k in range(10)), "step", "1 5 10 15 20 40", decay, "exact")
entry("(s + 1)^10, one coefficient off by 1e-4", "1", "1 10 45 120 210 252 210 120 45 10.0001 1", "step", "1 5 10 15 20 40", decay, "exact")
entry("(s + 1)^10 exactly", "1", "(1 1)^10", "step", "1 5 10 15 20 40", decay, "exact")
entry("(s + 1)^50", "1", "(1 1)^50", "step", "10 30 50 60 80 120", decay, "exact")
entry("Wilkinson 10", "3628800", " ".join(f"(1 {k})" for k in range(1, 11)), "step", "0.1 0.5 1 2 4 8", decay, "exact")
wilkinson = lambda n: (str(mp.factorial(n).__int__()), " ".join(f"(1 {k})" for k in range(1, n + 1)), " ".join(str(-k) for k in range(1, n + 1)))
num, den, poles = wilkinson(20)
entry("Wilkinson 20", num, den, "step", "0.1 0.5 1 2 4 8", decay, "exact", poles=poles)
num, den, poles = wilkinson(50)
entry("Wilkinson 50", num, den, "step", "0.5 1 2 4 6 12", decay, "exact", poles=poles)
entry("Wilkinson 50, impulse", num, den, "impulse", "0.5 1 2 4 6 12", decay, "0", poles=poles)
chain = [F(1) + F(k, 10) for k in range(30)]
entry("thirty tanks in a row", "1", " ".join(f"(1 {float(p)})" for p in chain), "impulse", "2 5 10 15 20 40", decay, "0", poles=" ".join(str(-p) for p in chain))
decades = [F(10) ** k for k in range(-6, 7)]
entry("poles -1e-6 to -1e6, every power", "1", " ".join(f"(1 1e{k})" for k in range(-6, 7)), "step", "1e-3 1 1e3 1e5 1e6 1e7", decay, "exact", poles=" ".join(str(-p) for p in decades))
entry("stiff, 1e-6 s and 1e6 s", "1", "(1e-6 1) (1e6 1)", "impulse", "1e-7 1e-6 1e-5 1 1e6 5e6", decay, "0", poles="-1e6 -1e-6")
entry("stiff, with a cluster at the fast end", "1", "(1e-6 1) (1e-6 1.000000000001) (1 1)", "step", "1e-7 1e-6 1e-5 0.1 1 10", decay, "exact", poles="-1e6 -1000000.000001 -1")
entry("coefficients 1e-12 to 1e12, a pair on the axis", "1e12", "1e-12 1e-3 1e3 1e12", "step", "1e-9 1e-8 1e-7 1e-6 2e-6 5e-6", "sustained_oscillation")
entry("a double pair on the axis", "1", "(1 0 1)^2", "impulse", "1 5 20 50", "growing_oscillation")
entry("a double pair on the axis and a decay", "1", "(1 0 4)^2 (1 1)", "step", "1 5 10 30", "growing_oscillation")
entry("two pairs on the axis 1e-15 apart", "1", "(1 0 1) (1 0 1.000000000000002)", "impulse", "1 5 20 50", "sustained_oscillation")
entry("a zero 1e-10 beside its pole", "1 1.0000000001", "(1 1) (1 2)", "impulse", near, decay, "0")
entry("a zero 1e-10 beside a pole on the right", "1 -1.0000000001", "(1 -1) (1 2)", "impulse", "1 5 10 20 30", growth)
entry("a cluster beside a pole on the right", "1", "(1 2 1.0000000000000000000000000000000000000001) (1 -0.5)", "step", "1 5 10 20", growth)
entry("a cluster on the right", "1", "1 -2 0.999999999999999999999999999999", "impulse", "1 3 5 10", growth)
entry("two hardly damped pairs 1e-10 apart", "1", "(1 0.02 1) (1 0.02 1.0000000001)", "impulse", "1 5 20 100 300", swings, "0")
entry("an integrator 1e-20 beside its lag", "1", "(1 0) (1 1) (1 1.00000000000000000001)", "impulse", near, decay, "0.99999999999999999999")
