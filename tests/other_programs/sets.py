"""Sealed sets of experiments by the programs of this folder: what is true of a set, how clear that is, and its files.

Classes of sets, and what is right to say of each (`right` of the truth lists all that counts; names as the verdict writes them):

| class | what is true | right |
|---|---|---|
| null | the base case, inputs off within their uncertainty | none |
| null_noise | the same, noise 2 to 3 times as stated | none |
| null_correlated | the same, noise of each path correlated from sample to sample (0.5 to 0.9) | none |
| single | one effect of the library at 1/8, 1/4, 1/2 or 1 of its expected strength | the effect |
| pair | two, at 1/2 or 1, each 3 sd clear given the other | both |
| several | three to five, at 1/2 or 1, each 5 sd clear given the others | all of them |
| outside | a force that no library holds, 5 sd clear of inputs and noise | outside |
| input | an input that differs from what is stated by more than 3 standard uncertainties at all points, 5 sd clear | input:KEY; of the whole flow also operating_point |
| blunder | a wrong unit, sign, clock, frame rate, or calibration of a group of points | unit:UNIT, sign:AXIS, clock, frame_rate, scale:GROUP |
| local | an effect that acts after a time or in a part of the domain only, 5 sd clear | the effect (for the calibration "outside" is true, too: it names nothing wrong) |
| outliers | nothing, or one effect, and 1 to 2 % of the samples 20 to 150 u off | none, or the effect |

How clear: the signal of what acts over noise, with the uncertain inputs free within their priors and every other effect that acts free to any
strength (each 100 times its signal), all by differences of this program's own runs about the truth:

    d^2 = S^T C^-1 S - b^T (I + J^T C^-1 J)^-1 b,   b = J^T C^-1 S

C: variances of the means of the repeats, with the true noise. `detectability` is that of the least clear of what acts. `clear_of_library`:
the same with all effects of the library free: what is small there no diagnosis can tell from the library. `clear_of_forms`: the least clear
again, with the laws of what acts free between their two forms by a third of the difference, as far as a diagnosis leaves it open
(docs/theory.md, "Forms of a law"). The two forms of the pressure gradient exclude each other, and nothing between them is open.

The truth goes to sealed/NAME.json; NAME does not tell it, and its SHA-256 is in sealed.log before the set is diagnosed.
"""
import hashlib
import json

import numpy

CLASSES = ("null", "null_noise", "null_correlated", "single", "pair", "several", "outside", "input", "blunder", "local", "outliers")
ANY_STRENGTH = 100


def signal_over_noise(signal, variance, columns):
    J = numpy.array(columns)
    whitened = signal / variance
    b = J @ whitened
    A = numpy.eye(len(J)) + (J / variance) @ J.T
    return float(numpy.sqrt(max(0.0, signal @ whitened - b @ numpy.linalg.solve(A, b))))


def at_times(instants, values, times):
    """Linear between the steps of a run; before its start what moves is held where it starts."""
    step = instants[1] - instants[0]
    at = numpy.clip(numpy.asarray(times) / step, 0, len(instants) - 1)
    before = numpy.minimum(at.astype(int), len(instants) - 2)
    share = at - before
    return (1 - share) * values[..., before] + share * values[..., before + 1]


class Runs:
    """Runs of a program at the points of one set."""

    def __init__(self, program, points):
        self.program, self.points = program, points
        self.training = range(program.N_TRAINING)

    def __call__(self, variants, points=None, times=None):
        """Values of [variant, point, observable, sample]; a variant is (numbers of all points, {input: one deviation a point})."""
        times = self.program.TIMES if times is None else times
        points = list(range(len(self.points))) if points is None else list(points)
        entries = []
        for numbers, deviations in variants:
            for i in points:
                off = {key: (0 if key.endswith("slope") else 1) + value[i] for key, value in deviations.items()}
                entries.append({**self.points[i], **numbers, **off})

        def p(name, default=None):
            return numpy.array([float(entry.get(name, default) if default is not None else entry[name]) for entry in entries])

        instants, values = self.program.simulate(p, max(times))
        sampled = at_times(instants, values, times)
        return sampled.reshape(len(variants), len(points), *sampled.shape[1:])

    def difference(self, a, b):
        """a - b of [point, observable, sample], flat; of angles of an axis modulo pi."""
        change = a - b
        for o, observable in enumerate(self.program.OBSERVABLES):
            if observable["kind"] == "angle":
                change[:, o] = (change[:, o] + numpy.pi / 2) % numpy.pi - numpy.pi / 2
        return change.ravel()


class Clarity:
    """How clear something is in the data of the training points of a set."""

    def __init__(self, runs, theta, other, deviations, replicates, noise_factor=1.0):
        self.runs, self.theta, self.other, self.deviations = runs, theta, other, deviations
        program, n = runs.program, len(runs.points)
        shape = (len(runs.training), len(program.OBSERVABLES), len(program.TIMES))
        self.variance = numpy.empty(shape)
        for o, observable in enumerate(program.OBSERVABLES):
            self.variance[:, o] = (noise_factor * observable["noise"]) ** 2 / replicates
        self.variance = self.variance.ravel()
        self.inputs = [key for key in program.INPUTS] + ["drag_law_uncertainty.slope"]
        self.u = {**program.INPUTS, "drag_law_uncertainty.slope": program.INPUTS["drag_law_uncertainty"] / numpy.log(10)}
        self.everything = all = {**theta, **other}
        variants = [(all, deviations)]
        for name in theta:
            variants.append(({**other, **{k: v for k, v in theta.items() if k != name}}, deviations))
        variants.append((theta, deviations))
        for key in self.inputs:
            for side in (0.5, -0.5):
                moved = {**deviations, key: deviations.get(key, numpy.zeros(n)) + side * self.u[key]}
                variants.append((all, moved))
        values = runs(variants, runs.training)
        self.values = values[0]
        difference = runs.difference
        self.signal = {name: difference(values[0], values[1 + i]) for i, name in enumerate(theta)}
        self.other_signal = difference(values[0], values[1 + len(theta)])
        at = 2 + len(theta)
        columns = {}
        for key in self.inputs:
            columns[key] = difference(values[at], values[at + 1]).reshape(shape)
            at += 2
        self.columns = {}  # by input
        for key, column in columns.items():
            own = [numpy.where(numpy.arange(shape[0])[:, None, None] == i, column, 0.0).ravel() for i in range(shape[0])]
            if key.startswith("drag_law"):
                self.columns[key] = [column.ravel()]
            elif key == "flow.amplitude":
                self.columns[key] = own
            else:
                self.columns[key] = [one / numpy.sqrt(2) for one in [column.ravel(), *own]]
        self.bias = []
        for o, observable in enumerate(program.OBSERVABLES):
            if observable["bias"]:
                column = numpy.zeros(shape)
                column[:, o] = observable["bias"]
                self.bias.append(column.ravel())

    def free(self):
        return [column for columns in self.columns.values() for column in columns] + self.bias

    def of_effects(self):
        """Each effect that acts, given the others."""
        return self.of_each(self.signal)

    def of_each(self, signals, columns=()):
        clear = {}
        for name, signal in signals.items():
            others = [ANY_STRENGTH * s for other, s in signals.items() if other != name]
            clear[name] = signal_over_noise(signal, self.variance, self.free() + others + list(columns))
        return clear

    def of_forms(self):
        """The least clear effect that acts, given the others and the forms that are open."""
        program, columns = self.runs.program, []
        for flag, effect in program.FORMS.items():
            if effect in self.theta:
                points = [{**point, flag: 1 - point[flag]} for point in self.runs.points]
                values = Runs(program, points)([(self.everything, self.deviations)], self.runs.training)[0]
                columns.append(self.runs.difference(values, self.values) / 3)
        return min(self.of_each(self.signal, columns).values())

    def of(self, signal):
        return signal_over_noise(signal, self.variance, self.free())

    def of_input(self, key, deviation):
        """Of an input that differs by more than is known: the part of the deviation that the prior does not explain."""
        base = {**self.deviations, key: self.deviations[key] - deviation}
        values = self.runs([({**self.theta, **self.other}, base)], self.runs.training)[0]
        return self.of(self.runs.difference(self.values, values))

    def library(self):
        """What a little of each other effect would add, {effect: signal at its expected strength}."""
        little, names = 0.2, [name for name in self.runs.program.EXPECTED if name not in self.theta]
        variants = [({**self.everything, name: little * self.runs.program.EXPECTED[name]}, self.deviations) for name in names]
        values = self.runs(variants, self.runs.training)
        return {name: self.runs.difference(with_it, self.values) / little for name, with_it in zip(names, values)}

    def of_library(self, signal):
        return signal_over_noise(signal, self.variance, self.free() + [ANY_STRENGTH * s for s in self.library().values()])


def drawn_deviations(program, random, n):
    """Inputs off within their uncertainty: at all points alike, at each by its own, or half and half."""
    manner = random.integers(3)
    deviations = {}
    for key, u in program.INPUTS.items():
        common, own = random.standard_normal(), random.standard_normal(n)
        if key.startswith("drag_law"):
            deviations[key] = numpy.full(n, 0.6 * u * common)  # the rest is the other law
        elif key == "flow.amplitude":
            deviations[key] = u * own
        else:
            deviations[key] = u * [numpy.full(n, common), own, (common + own) / numpy.sqrt(2)][manner]
    return deviations


def blunder(program, random, times):
    """One mistake of whoever measured: its kind, how it is named, and its size."""
    kind = ["unit", "sign", "clock", "frame_rate", "scale"][random.integers(5)]
    lengths = [o["id"] for o in program.OBSERVABLES if o["id"] in "xyz"]
    if kind == "unit":
        stated = "m" if random.uniform() < 0.5 else "mm"
        return {"kind": kind, "stated": stated, "right": "unit:" + stated}
    if kind == "sign":
        axis = [id for id in lengths if id != "y"][random.integers(2)]
        return {"kind": kind, "axis": axis, "right": "sign:" + axis}
    if kind == "clock":
        return {"kind": kind, "late": random.choice([-1, 1]) * random.uniform(0.03, 0.06) * times[-1], "right": "clock"}
    if kind == "frame_rate":
        return {"kind": kind, "factor": 1 + random.choice([-1, 1]) * random.uniform(0.04, 0.2), "right": "frame_rate"}
    groups = sorted(set(program.groups()))
    group = groups[random.integers(len(groups))]
    return {"kind": kind, "group": group, "factor": 1 + random.choice([-1, 1]) * random.uniform(0.03, 0.1), "right": "scale:" + group}


def times_of(program, mistake):
    """When the samples were there that are written down as those of program.TIMES."""
    if mistake.get("kind") == "clock":
        return program.TIMES + mistake["late"]
    if mistake.get("kind") == "frame_rate":
        return program.TIMES * mistake["factor"]
    return program.TIMES


def mismeasured(program, mistake, values):
    """Numbers that a wrong axis or a wrong calibration gives, [point, observable, sample]."""
    values = values.copy()
    if mistake.get("kind") == "sign":
        values[:, [o["id"] for o in program.OBSERVABLES].index(mistake["axis"])] *= -1
    if mistake.get("kind") == "scale":
        of_group = numpy.array([group == mistake["group"] for group in program.groups()])[: len(values)]
        for o, observable in enumerate(program.OBSERVABLES):
            if observable["unit"] in ("m", "mm"):
                values[of_group, o] *= mistake["factor"]
    return values


def head_of_case(end, density, p):
    """First lines of the base case of a point, which all programs share."""
    return f"""[time]
end_s = {end}
step_s = 0.001
[gravity]
acceleration_m_s2 = [0, 0, -9.81]
[flow]
kind = "prescribed"
density_kg_m3 = {density}
kinematic_viscosity_m2_s = {p["viscosity"]}
velocity_m_s = [{p["velocity"]}, 0, 0]
gradient_per_s = [[0, 0, {p["shear"]}], [0, 0, 0], [0, 0, 0]]
amplitude_m_s = [{p["amplitude"]}, 0, 0]
angular_frequency_rad_s = [{p["omega"]}, 0, 0]
"""


def effects_that_fit(program, random, number):
    """So many effects, none of them another name of one that is there."""
    names = []
    while len(names) < number:
        name = list(program.EXPECTED)[random.integers(len(program.EXPECTED))]
        if program.SAME_CAUSE.get(name, name) not in [program.SAME_CAUSE.get(one, one) for one in names]:
            names.append(name)
    return sorted(names)


def strengths_of(program, random, names, shares):
    return {name: program.EXPECTED[name] * shares[random.integers(len(shares))] * random.uniform(0.8, 1.2) for name in names}


class Draw:
    """What one attempt at a set makes true; `clear_enough` says whether the class takes it."""

    def __init__(self, program, kind, random):
        self.program, self.kind, self.random = program, kind, random
        self.points = program.points(random)
        self.runs, n = Runs(program, self.points), len(self.points)
        self.deviations = drawn_deviations(program, random, n)
        self.replicates = int(random.choice([3, 5, 10] if kind in ("null_noise", "null_correlated") else [1, 3, 3, 5, 5, 10]))
        self.theta, self.other, self.mistake = {}, {}, {}
        self.noise_factor, self.correlation, self.outlier_share = 1.0, 0.0, 0.0
        self.subset, self.strength, self.wrong = "all", 0.0, None
        self.right = ["none"]
        getattr(self, "draw_" + kind)()

    def act(self, names, shares):
        self.theta = strengths_of(self.program, self.random, names, shares)
        self.strength = min(self.theta[name] / self.program.EXPECTED[name] for name in names)
        self.right = ["+".join(sorted(self.program.SAME_CAUSE.get(name, name) for name in names))]

    def draw_null(self):
        pass

    def draw_null_noise(self):
        self.noise_factor = self.random.uniform(2, 3)

    def draw_null_correlated(self):
        self.correlation = self.random.uniform(0.5, 0.9)

    def draw_single(self):
        self.act(effects_that_fit(self.program, self.random, 1), [1 / 8, 1 / 4, 1 / 2, 1, 1])

    def draw_pair(self):
        self.act(effects_that_fit(self.program, self.random, 2), [1 / 2, 1])

    def draw_several(self):
        """Of a hundred combinations the first that a linear estimate about the base case takes for clear; else nothing, and the next draw."""
        library = Clarity(self.runs, {}, {}, self.deviations, self.replicates)
        signals = library.library()
        for _ in range(100):
            self.act(effects_that_fit(self.program, self.random, int(self.random.integers(3, 6))), [1 / 2, 1, 1])
            share = {name: theta / self.program.EXPECTED[name] for name, theta in self.theta.items()}
            if min(library.of_each({name: share[name] * signals[name] for name in self.theta}).values()) >= 5.5:
                return
        self.theta = {}

    def draw_outside(self):
        self.subset = list(self.program.OUTSIDE)[self.random.integers(len(self.program.OUTSIDE))]
        self.other, self.strength = self.program.unknown_force(self.random, self.subset), 1.0
        self.right = ["outside"]

    def draw_input(self):
        keys = list(self.program.WRONG_INPUTS)
        self.subset = keys[self.random.integers(len(keys))]
        low, high, self.right = self.program.WRONG_INPUTS[self.subset]
        self.wrong = self.random.choice([-1, 1]) * self.random.uniform(low, high) * self.program.INPUTS[self.subset]
        self.deviations[self.subset] = self.deviations[self.subset] + self.wrong
        self.strength = abs(self.wrong)

    def draw_blunder(self):
        self.mistake = blunder(self.program, self.random, self.program.TIMES)
        self.subset, self.right, self.strength = self.mistake["kind"], [self.mistake["right"]], 1.0

    def draw_local(self):
        name = self.program.LOCAL[self.random.integers(len(self.program.LOCAL))]
        self.act([name], [1, 2])
        self.other = self.program.gate(self.random)
        self.subset = "time" if "gate_time" in self.other else "place"

    def draw_outliers(self):
        if self.random.uniform() < 0.5:
            self.act(effects_that_fit(self.program, self.random, 1), [1])
        self.outlier_share = self.random.uniform(0.01, 0.02)

    def measure(self):
        """Clarity of what acts."""
        runs, self.clear, self.clear_of_library, self.gap_over_floor, self.detectability = self.runs, {}, None, 0.0, 0.0
        if self.right == ["none"] or (self.kind == "several" and not self.theta):
            return
        self.clarity = Clarity(runs, self.theta, self.other, self.deviations, self.replicates, self.noise_factor)
        self.clear = self.clarity.of_effects()
        gap = numpy.zeros(len(self.clarity.variance))
        if self.kind == "outside":
            self.clear = {"outside": self.clarity.of(self.clarity.other_signal)}
            self.clear_of_library = self.clarity.of_library(self.clarity.other_signal)
            gap = self.clarity.other_signal
        elif self.kind == "input":
            n = len(self.points)
            self.clear = {self.right[0]: self.clarity.of_input(self.subset, numpy.full(n, self.wrong))}
        elif self.mistake:
            seen = runs([({}, self.deviations)], runs.training, times_of(self.program, self.mistake))[0]
            gap = runs.difference(mismeasured(self.program, self.mistake, seen), self.clarity.values)
            self.clear = {self.right[0]: 1e6 if self.mistake["kind"] == "unit" else self.clarity.of(gap)}
        if self.theta:
            without = {key: value for key, value in self.other.items() if key.startswith("gate")}
            base = runs([(without, self.deviations)], runs.training)[0]
            gap = runs.difference(self.clarity.values, base)
        floor = self.clarity.variance + sum(column**2 for column in self.clarity.free())
        self.gap_over_floor = float(numpy.sqrt((gap**2 / floor).mean()))
        self.detectability = min(self.clear.values(), default=0.0)

    def clear_enough(self):
        if self.kind in ("several", "outside", "input", "blunder", "local"):
            return self.detectability >= 5
        if self.kind == "pair":
            return self.detectability >= 3
        if self.kind == "single" and self.strength < 0.4:  # at full strength these data would show it
            return self.detectability / self.strength >= 3
        return not self.theta or self.detectability >= 3

    def truth(self, number, seed):
        return {
            "program": self.program.NAME, "number": number, "seed": seed, "kind": self.kind, "subset": self.subset, "truth": self.right[0],
            "right": self.right, "same_cause": self.program.SAME_CAUSE, "theta": self.theta, "strength": self.strength,
            "replicates": self.replicates, "detectability": self.detectability, "clear": self.clear,
            "clear_of_library": self.clear_of_library, "clear_of_forms": self.clarity.of_forms() if self.theta else None, "gap_over_floor": self.gap_over_floor,
            "other": {k: float(v) for k, v in self.other.items()}, "mistake": {k: v for k, v in self.mistake.items() if k != "right"},
            "noise_factor": self.noise_factor, "correlation": self.correlation, "outlier_share": self.outlier_share,
            "deviations": {key: [float(v) for v in value] for key, value in self.deviations.items()},
        }

    def write(self, folder):
        """DIAGNOSIS.toml, data.csv and the base cases."""
        program, random, runs = self.program, self.random, self.runs
        folder.mkdir(parents=True, exist_ok=True)
        scale = [observable["factor"] for observable in program.OBSERVABLES]
        units = [observable["unit"] for observable in program.OBSERVABLES]
        if self.mistake.get("kind") == "unit":  # the other length is written into the file
            stated, written = self.mistake["stated"], {"m": "mm", "mm": "m"}[self.mistake["stated"]]
            size = {"m": 1.0, "mm": 1e3}
            lengths = [unit in size for unit in units]
            file_scale = [size[written] if is_length else one for one, is_length in zip(scale, lengths)]
            scale = [size[stated] if is_length else one for one, is_length in zip(scale, lengths)]
            units = [stated if is_length else unit for unit, is_length in zip(units, lengths)]
        else:
            file_scale = scale
        text = [f'[experiment]\nname = "{program.NAME}s of another program"\ndata = "data.csv"\n']
        for o, observable in enumerate(program.OBSERVABLES):
            text.append(f'[[observable]]\nid = "{observable["id"]}"\nunit = "{units[o]}"\nkind = "{observable["kind"]}"\n'
                        f'noise_u = {scale[o] * observable["noise"]:.6g}\n')
            if observable["bias"]:
                text.append(f'bias_u = {scale[o] * observable["bias"]:.6g}\ncalibration_group = "{observable["id"]} of the camera"\n')
        input_u = ", ".join(f'"{key}" = {u}' for key, u in program.INPUTS.items())
        for i, (point, group) in enumerate(zip(self.points, program.groups())):
            id, role = "ABCDEFGH"[i], "train" if i < program.N_TRAINING else "withheld"
            (folder / f"{id}.toml").write_text(program.case_text(point))
            text.append(f'[[point]]\nid = "{id}"\ncase = "{id}.toml"\nrole = "{role}"\ngroup = "{group}"\ninput_u = {{ {input_u} }}\n')
        (folder / "DIAGNOSIS.toml").write_text("\n".join(text))
        values = runs([({**self.theta, **self.other}, self.deviations)], None, times_of(program, self.mistake))[0]
        values = mismeasured(program, self.mistake, values)
        bias = [observable["bias"] * random.standard_normal() for observable in program.OBSERVABLES]
        rows = ["point,replicate,t_s,observable,value"]
        n_samples, rho = len(program.TIMES), self.correlation
        for i in range(len(self.points)):
            for replicate in range(1, self.replicates + 1):
                for o, observable in enumerate(program.OBSERVABLES):
                    noise = random.standard_normal(n_samples)
                    for k in range(1, n_samples):
                        noise[k] = rho * noise[k - 1] + numpy.sqrt(1 - rho**2) * noise[k]
                    out = random.uniform(size=n_samples) < self.outlier_share
                    noise = self.noise_factor * noise + out * random.choice([-1, 1], n_samples) * random.uniform(20, 150, n_samples)
                    seen = values[i, o] + bias[o] + observable["noise"] * noise
                    written = numpy.round(seen * observable["factor"] / observable["smallest"]) * observable["smallest"] / observable["factor"]
                    for t, value in zip(program.TIMES, written):
                        rows.append(f'{"ABCDEFGH"[i]},{replicate},{t:.6g},{observable["id"]},{file_scale[o] * value:.8g}')
        (folder / "data.csv").write_text("\n".join(rows) + "\n")


def make_set(program, kind, number, seed, folder):
    """Writes set `number` of a class into folder/sets, seals its truth; returns its name and the fingerprint."""
    key = f"{program.NAME}|{kind}|{number}|{seed}"
    random = numpy.random.default_rng(int.from_bytes(hashlib.sha256(key.encode()).digest()[:8], "little"))
    name = "set_" + hashlib.sha256(("name of " + key).encode()).hexdigest()[:12]
    for _ in range(1000):
        draw = Draw(program, kind, random)
        draw.measure()
        if draw.clear_enough():
            break
    else:
        raise RuntimeError(f"{key}: no such set in 1000 draws")
    draw.write(folder / "sets" / name)
    text = json.dumps(draw.truth(number, seed), indent=1) + "\n"
    (folder / "sealed").mkdir(exist_ok=True)
    (folder / "sealed" / f"{name}.json").write_text(text)
    fingerprint = hashlib.sha256(text.encode()).hexdigest()
    with open(folder / "sealed.log", "a") as log:
        log.write(f"{name} sha256 {fingerprint}\n")
    return name, fingerprint
