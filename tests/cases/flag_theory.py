"""Linear theory of a flag in two dimensions: an elastic plate that is clamped at its leading edge in a stream along it, without friction, with the wake that its trailing edge sheds.

Lengths in the plate's length L, times in L/U, masses in rho: mass per area mu = m/(rho L), bending stiffness beta = B/(rho U^2 L^3) per width. Deflection eta(x) e^(sigma t), pressure jump p:

  mu sigma^2 eta + beta eta'''' = p,   eta(0) = eta'(0) = eta''(1) = eta'''(1) = 0
  V = sigma eta + eta' = b_0/2 + sum b_n cos(n theta),   x = (1 + cos(theta))/2,   s = sigma/2
  p = a_0 tan(theta/2) + 2 sum a_n sin(n theta),   a_n = -b_n - s (b_(n-1) - b_(n+1))/(2 n),   a_0 = b_1 - (b_0 + b_1) C(s)
  C(s) = K_1(s)/(K_0(s) + K_1(s)): Theodorsen's function, which holds the wake; K_0, K_1: Bessel functions

eta is a sum of the shapes of the plate in a vacuum (Galerkin). Pressure by the acceleration potential: V is the velocity of the water at the plate, a_n follow from its acceleration, a_0 from the water that comes to the leading edge
at rest. Sources: Theodorsen (1935), General theory of aerodynamic instability and the mechanism of flutter, NACA report 496; Wu (1961), Swimming of a waving plate, J. Fluid Mech. 10, 321-344; flutter of the plate: Kornecki, Dowell and
O'Brien (1976), J. Sound Vib. 47, 163-178; Eloy, Souilliez and Schouveiler (2007), Flutter of a rectangular plate, J. Fluids Struct. 23, 904-919.
"""
import numpy

N_POINTS, N_WAVES = 400, 60  # points in theta, terms of the series


def theodorsen(s):
    """C(s), also of decaying motion (Re s < 0), by K_n(s) = 1/2 integral of e^(-s cosh t) cosh(n t) along a path on which s cosh t grows at both ends."""
    u = numpy.linspace(-12, 12, 2401)
    turn = -numpy.angle(s)
    t, slope = u + 1j * turn * numpy.tanh(u), 1 + 1j * turn / numpy.cosh(u) ** 2
    kernel = numpy.exp(-s * numpy.cosh(t)) * slope
    first = (kernel * numpy.cosh(t)).sum()
    return first / (kernel.sum() + first)


def pressure(b, s, theta):
    """p at theta for coefficients b_0 ... b_(N + 1) of V; the last index of b may count shapes."""
    n = numpy.arange(1, len(b) - 1)
    a = -b[1:-1] - s * (b[:-2] - b[2:]) / (2 * n.reshape(-1, *[1] * (b.ndim - 1)))
    a_0 = b[1] - (b[0] + b[1]) * theodorsen(s)
    return numpy.tensordot(numpy.tan(theta / 2), a_0, 0) + 2 * numpy.sin(numpy.outer(theta, n)) @ a


def points():
    """Middles of equal parts of 0 ... pi."""
    return (numpy.arange(N_POINTS) + 0.5) * numpy.pi / N_POINTS


def coefficients(values):
    """b_n of the values at points()."""
    return 2 / N_POINTS * numpy.cos(numpy.outer(numpy.arange(N_WAVES + 2), points())) @ values


class Flag:
    def __init__(self, shapes=10):
        self.theta = points()
        x = (1 + numpy.cos(self.theta)) / 2
        k = (numpy.arange(shapes) + 0.5) * numpy.pi
        for _ in range(50):  # cos k cosh k = -1
            k -= (numpy.cos(k) + 1 / numpy.cosh(k)) / (-numpy.sin(k) - numpy.sinh(k) / numpy.cosh(k) ** 2)
        # cosh kx - cos kx - r (sinh kx - sin kx), r near 1: the growing part is its difference from 1.
        grow = (numpy.sin(k) - numpy.cos(k) - numpy.exp(-k)) / (numpy.sinh(k) + numpy.sin(k)) / 2
        r, kx = 1 - 2 * grow, numpy.outer(x, k)
        up, down = grow * numpy.exp(kx), (1 - grow) * numpy.exp(-kx)
        self.shape = up + down - numpy.cos(kx) + r * numpy.sin(kx)
        slope = k * (up - down + numpy.sin(kx) + r * numpy.cos(kx))
        self.weight = numpy.pi / N_POINTS * numpy.sin(self.theta) / 2  # of the points in an integral over x
        self.b_shape, self.b_slope = coefficients(self.shape), coefficients(slope)
        self.mass = self.projection(self.shape)
        self.stiffness = self.mass * k**4

    def projection(self, values):
        return (self.shape.T * self.weight) @ values

    def matrix(self, sigma, mu, beta):
        """Of the amplitudes of the shapes: singular where sigma is an eigenvalue."""
        return mu * sigma**2 * self.mass + beta * self.stiffness - self.projection(pressure(sigma * self.b_shape + self.b_slope, sigma / 2, self.theta))

    def eigenvalue(self, sigma, mu, beta):
        """The eigenvalue that Newton's method for the determinant finds from `sigma` on."""
        for _ in range(60):
            h = 1e-5 * max(1, abs(sigma))
            slope = (self.matrix(sigma + h, mu, beta) - self.matrix(sigma - h, mu, beta)) / (2 * h)
            step = 1 / numpy.trace(numpy.linalg.solve(self.matrix(sigma, mu, beta), slope))
            sigma -= step * min(1, 0.5 / abs(step))
            if abs(step) < 1e-9:
                return sigma
        raise ValueError(f"no eigenvalue near {sigma}")

    guesses = {2: (0.08, 3.7j), 1: (0.032, 3.1j), 0.1: (0.0009, 4.6j)}  # by mass: stiffness and eigenvalue near the onset

    def onset(self, mu):
        """beta and sigma where flutter begins as the plate becomes softer, for a mass of `guesses`."""
        near, sigma = self.guesses[mu]
        low, high = near / 2, near * 2
        for _ in range(40):
            middle = (low * high) ** 0.5
            sigma = self.eigenvalue(sigma, mu, middle)
            low, high = (middle, high) if sigma.real > 0 else (low, middle)
        return middle, sigma

    def flutter_mode(self, mu, beta):
        """sigma of the mode that flutters, followed from its onset to `beta`."""
        at, sigma = self.onset(mu)
        for part in numpy.linspace(0, 1, 9)[1:]:
            sigma = self.eigenvalue(sigma, mu, at * (beta / at) ** part)
        return sigma


def observed_mode(time, y, frequency):
    """sigma of the oscillation that decays least, about as fast as `frequency`, of a record in equal steps.

    Two oscillations about a constant, the mode that flutters and what a push leaves besides: y(t + 4 T) is a sum of y(t) ... y(t + 3 T) and a constant, and the roots of that recursion are e^(sigma T).
    """
    step = (time[-1] - time[0]) / (len(time) - 1)
    lag = round(2 / frequency / step)
    known = numpy.stack([*(y[k * lag : (k - 4) * lag] for k in range(4)), numpy.ones(len(y) - 4 * lag)], axis=1)
    recursion = numpy.linalg.lstsq(known, y[4 * lag :], rcond=None)[0]
    roots = numpy.log(numpy.roots([1, *-recursion[3::-1]]).astype(complex)) / (lag * step)
    return max((root for root in roots if 0.5 < root.imag / frequency < 1.5), key=lambda root: root.real)
