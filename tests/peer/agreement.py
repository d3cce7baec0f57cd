"""Do two noisy measurements of the same numbers agree? Standard library only."""
import dataclasses
import math
import statistics

# Steps of the sector format's 16-bit numbers.
TRANSFER_STEP, VISIBILITY_STEP = 0.5 / 32767, 1.0 / 32767

# What the issue asks for, in each of outdoors and Sponza; a probe in the dark proves little.
MIN_LIT_PROBES = 50
# Of z squared 1.07 is expected: z is Student's with 31 degrees of freedom. Values of one probe share rays; taking
# 50 probes for 100 independent values, three standard deviations are 0.43.
MAX_CHI2 = 1.5
# Mean difference over probes, which are independent, in standard errors: 1 in 16,000 by chance, for 5 quantities a run.
MAX_BIAS_Z = 4
# Worst of some 4,000 values; Student's z passes 7 by chance once in 10^7.
MAX_WORST_Z = 7
# A comparison with too few samples agrees with everything: the mean must be known this well, relative to it.
MAX_BIAS_SE = 0.005


@dataclasses.dataclass
class Pair:
    """One number by drtv and by Cycles, each with its standard error."""

    probe: int
    drtv: float
    drtv_se: float
    cycles: float
    cycles_se: float

    @property
    def difference(self):
        return self.drtv - self.cycles

    @property
    def z(self):
        return self.difference / math.hypot(self.drtv_se, self.cycles_se)


@dataclasses.dataclass
class Agreement:
    name: str
    values: int
    mean: float  # of Cycles's numbers; all below but chi2 and worst_z are relative to it
    bias: float  # mean difference, drtv less Cycles
    bias_se: float  # its standard error, probes taken as independent
    rms: float  # of the differences
    noise: float  # of the standard errors
    chi2: float  # mean of z squared
    worst_z: float


def mean_and_se(samples):
    mean = statistics.fmean(samples)
    return mean, math.sqrt(sum((x - mean) ** 2 for x in samples) / (len(samples) - 1) / len(samples))


def pooled_se(fine, coarse):
    """Standard error of each of `fine`, from bakes with N rays and with the first N/4 of the same: if s^2/N is the variance
    of the fine one, their difference has 3 s^2/N. (Of independent rays. drtv's even ones do better than that.)
    """
    return math.sqrt(statistics.fmean((a - b) ** 2 for a, b in zip(fine, coarse)) / 3)


def agreement(name, pairs):
    pairs = [p for p in pairs if p.drtv or p.cycles]  # both exactly black: nothing to compare
    if not pairs:
        return Agreement(name, 0, 0, 0, math.inf, 0, 0, 0, 0)
    mean = statistics.fmean(p.cycles for p in pairs) or math.nan
    by_probe = {}  # a probe's numbers share their rays; its mean difference is one observation
    for p in pairs:
        by_probe.setdefault(p.probe, []).append(p.difference)
    bias, bias_se = (
        mean_and_se([statistics.fmean(d) for d in by_probe.values()])
        if len(by_probe) > 1
        else (math.nan, math.inf)
    )
    return Agreement(
        name,
        len(pairs),
        mean,
        bias / mean,
        bias_se / mean,
        math.sqrt(statistics.fmean(p.difference**2 for p in pairs)) / mean,
        math.sqrt(statistics.fmean(p.drtv_se**2 + p.cycles_se**2 for p in pairs)) / mean,
        statistics.fmean(p.z**2 for p in pairs),
        max((p.z for p in pairs), key=abs),
    )


def complaints(results, lit_probes):
    """A sentence for each way in which they disagree, or in which nobody could tell. No number passes for agreement."""
    found = (
        []
        if lit_probes >= MIN_LIT_PROBES
        else [f"only {lit_probes} probes see any light, {MIN_LIT_PROBES} are needed"]
    )
    for r in results:
        if not r.bias_se <= MAX_BIAS_SE:
            found.append(
                f"{r.name}: the mean difference is known to {100 * r.bias_se:.2f} % only, not to {100 * MAX_BIAS_SE} %: more samples"
            )
        if not abs(r.bias) <= MAX_BIAS_Z * r.bias_se:
            found.append(
                f"{r.name}: drtv differs by {100 * r.bias:.3f} % on average, {r.bias / r.bias_se if r.bias_se else math.inf:.1f} standard errors"
            )
        if not r.chi2 <= MAX_CHI2:
            found.append(
                f"{r.name}: the differences are {math.sqrt(r.chi2):.2f} times as large as the noise explains"
            )
        if not abs(r.worst_z) <= MAX_WORST_Z:
            found.append(f"{r.name}: one value is {r.worst_z:.1f} standard errors off")
    return found
