"""Shapes of sheets that bend but do not stretch (elastica), by shooting: a plate in a stream, and a strip folded into a loop on a table."""
import numpy


def runge_kutta(rate, y, length, steps):
    """The states at 0, h, ..., length of dy/ds = rate(s, y)."""
    h, states = length / steps, [numpy.array(y, float)]
    for k in range(steps):
        s, y = k * h, states[-1]
        a = rate(s, y)
        b = rate(s + h / 2, y + h / 2 * a)
        c = rate(s + h / 2, y + h / 2 * b)
        d = rate(s + h, y + h * c)
        states.append(y + h / 6 * (a + 2 * b + 2 * c + d))
    return numpy.array(states)


def bisection(is_low, low, high, steps=50):
    for _ in range(steps):
        middle = (low + high) / 2
        low, high = (middle, high) if is_low(middle) else (low, middle)
    return (low + high) / 2


def blade(C, buoyancy, steps=80, taper=1):
    """States (theta, w theta', force along the stream, force upwards) from the tip to the clamp of a blade of length 1 that stands on the ground in a stream.

    (w theta')' = -C F.n,  F' = -w (cos(theta)^2 n + (buoyancy/C) (0, 1)),  n = (cos(theta), -sin(theta)),  theta(0) = theta'(1) = F(1) = 0;  theta: angle to the vertical, F: force of what lies
    beyond s, w: width over that at the clamp, growing evenly to `taper` at the tip.
    Lengths in the blade's length l, forces in rho C_D b U^2 l/2, the upright drag of a blade as wide as at the clamp, b; C = rho C_D b U^2 l^3/(2 E I), buoyancy = (rho - rho_blade) g b d l^3/(E I); I at
    the clamp, d thickness.
    Shooting for theta(1) from the tip; model of Luhar and Nepf (2011), Limnol. Oceanogr. 56, 2003-2017, without friction.
    """
    def rate(s, y):
        n, w = numpy.array([numpy.cos(y[0]), -numpy.sin(y[0])]), taper - (taper - 1) * s
        return numpy.array([-y[1] / w, C * (y[2:] @ n), *(w * (numpy.cos(y[0]) ** 2 * n + [0, buoyancy / C]))])

    def states(tip):
        return runge_kutta(rate, [tip, 0, 0, 0], 1, steps)

    return states(bisection(lambda tip: states(tip)[-1, 0] <= 0, 0, numpy.pi / 2))


def reconfiguration(C, steps=80, taper=1):
    """Drag over that of the rigid plate: half of a plate that is clamped along its middle across a stream, of length 1, or a sector of a disc, which is wider at its tip; model of Gosselin, de Langre and
    Machado-Almeida (2010), J. Fluid Mech. 650, 319-341, whose C of a sector contains the taper."""
    return blade(C / taper, 0, steps, taper)[-1, 2] / ((1 + taper) / 2)


def published_reconfiguration(C, steps=80):
    """The same by equation 5.11 of the paper, which leaves out the force along the plate: theta''' = C cos(theta)^2. R is 1 % less at C = 10 and 3 % less from C = 100 on."""
    def clamp(tip):
        return runge_kutta(lambda _, y: numpy.array([-y[1], -y[2], -C * numpy.cos(y[0]) ** 2, numpy.cos(y[0]) ** 3]), [tip, 0, 0, 0], 1, steps)[-1]

    return clamp(bisection(lambda tip: clamp(tip)[0] <= 0, 0, numpy.pi / 2, 40))[3]


def stuart_loop(steps=2000):
    """Places (x, y) of a strip that lies on a table, rises, turns over into a loop and lies on the table again, below itself; lengths in the bending length
    c = (B/w)^(1/3), B bending stiffness and w weight per width. The strip leaves the table at (0, 0).

    theta'' = (P - s) cos(theta),  theta = theta' = y = 0 at s = 0,  theta = -pi and theta' = y = 0 at the other end;  P: force of the table at s = 0
    Its height is 1/1.103. Shooting for P; Stuart (1966), Br. J. Appl. Phys. 17, 1215-1220.
    """
    def states(P):
        y = runge_kutta(lambda s, y: numpy.array([y[1], (P - s) * numpy.cos(y[0]), numpy.cos(y[0]), numpy.sin(y[0])]), [0, 0, 0, 0], 5, steps)
        bent = numpy.flatnonzero((y[:-1, 1] < 0) & (y[1:, 1] >= 0))[0]  # the loop ends behind it
        part = y[bent, 1] / (y[bent, 1] - y[bent + 1, 1])
        return numpy.vstack([y[: bent + 1], (1 - part) * y[bent] + part * y[bent + 1]])

    P = bisection(lambda force: states(force)[-1, 0] > -numpy.pi, 0.9, 1.0)
    return states(P)[:, 2:]
