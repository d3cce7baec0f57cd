#!/usr/bin/env python3
"""Every complaint fires on numbers made for it, and on no others. Needs neither Blender nor a bake."""
import random
import unittest

from agreement import Pair, agreement, complaints, mean_and_se, pooled_se

PROBES, VALUES, SE = 60, 12, 0.01


def pairs(change=lambda probe, value: value, se=SE):
    """Two measurements of 0.5, but for `change` on drtv's side and noise of SE on Cycles's."""
    chance = random.Random(1)
    return [
        Pair(n, change(n, 0.5), 0.0, chance.gauss(0.5, SE), se) for n in range(PROBES) for _ in range(VALUES)
    ]


def found(of, lit=PROBES):
    return " / ".join(complaints([agreement("T", of)], lit))


class Complaints(unittest.TestCase):
    def test_noise_alone_agrees(self):
        self.assertEqual(found(pairs()), "")

    def test_half_a_percent_more_is_a_bias(self):
        self.assertIn("on average", found(pairs(lambda _, value: 1.005 * value)))

    def test_one_probe_far_off_is_named(self):
        self.assertIn("one value is", found(pairs(lambda n, value: value + (0.12 if n == 7 else 0))))

    def test_spread_beyond_the_noise_is_told(self):
        self.assertIn(
            "as large as the noise explains",
            found(pairs(lambda n, value: value + (0.015 if n % 2 else -0.015))),
        )

    def test_too_much_noise_is_no_agreement(self):
        chance = random.Random(2)
        self.assertIn(
            "more samples", found([Pair(n, 0.5, 0.0, chance.gauss(0.5, 0.2), 0.2) for n in range(PROBES)])
        )

    def test_dark_probes_do_not_count(self):
        self.assertIn("49 probes see any light", found(pairs(), lit=49))
        self.assertIn("more samples", found([Pair(n, 0.0, 0.1, 0.0, 0.0) for n in range(PROBES)]))

    def test_no_number_is_no_agreement(self):
        self.assertNotEqual(found([Pair(n, float("nan"), 0.1, 0.5, 0.1) for n in range(PROBES)]), "")


class StandardErrors(unittest.TestCase):
    def test_replicas_give_theirs(self):
        self.assertEqual(mean_and_se([1.0, 2.0, 3.0, 2.0])[0], 2.0)
        self.assertAlmostEqual(mean_and_se([1.0, 2.0, 3.0, 2.0])[1], (2 / 3) ** 0.5 / 2)

    def test_nested_bakes_give_that_of_the_finer(self):
        chance = random.Random(3)
        quarters = [[chance.gauss(0, 1) for _ in range(4)] for _ in range(20000)]
        self.assertAlmostEqual(
            pooled_se([sum(q) / 4 for q in quarters], [q[0] for q in quarters]), 0.5, delta=0.01
        )


if __name__ == "__main__":
    unittest.main()
