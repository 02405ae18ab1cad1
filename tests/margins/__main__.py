"""Proves that the margins of tests in shaders, and of the CPU's, are no smaller than the errors that they are for.

Usage: python3 tests/margins. Needs no packages and no device. Ends with an error and the place if a margin is too
small, or if a function has changed so that a claim does not understand it any more.

The functions are read from their sources (reader.py) and evaluated on numbers that carry bounds (evaluator.py,
rounding.py): each is what a machine computes where the formula, on exact inputs, has another value. Bounds of its size
and of its error are polynomials with exact coefficients, in symbols for the inputs' sizes and errors. The model of
arithmetic stands in rounding.py.

A margin in the source is such a polynomial, too, of what it is at least. It is proved if none of its coefficients is
less than the error's, after facts have been applied that a claim states: that an intermediate result has a known bound,
that a centre and a half extent share the reach of their mesh. So it holds for all inputs, whatever their ratios.
docs/method.md says which margins are proved here, and which by hand.

Each constant of a margin is also lowered until the proof fails: *room* is by what factor it exceeds the least that
proves. With three quarters of that, the claim must fail.
"""
import sys
from fractions import Fraction

import cpu_claims
import cpu_node_claims
import double_claims
import node_claims
import own_tests
import triangle_claims
from reader import SourceError

TABLES = {
    "Pairs of triangles, floats": triangle_claims,
    "Nodes, floats": node_claims,
    "Doubles on a device": double_claims,
    "The CPU": cpu_claims,
    "Nodes and leaves, the CPU": cpu_node_claims,
}


def report(claim, owner, text):
    """Prints a row of the table, and returns a list of a complaint or none."""
    token, value = claim.sources.literal(owner, text), claim.sources.number(owner, text)
    least = claim.least_that_proves(owner, text)
    room = f"{float(value / least):.7g}" if least else "-"
    owner = owner.split("::")[-1]
    print(f"  {claim.name:29} {owner:18} {text[:44]:45} {float(value):12.8g} {float(least):12.8g}  {room}")
    if least == 0:
        wrong = "holds without this constant"
    elif not claim.lacking({token: least * Fraction(3, 4)}):
        wrong = "holds with 3/4 of the least that proves it"
    elif claim.lacking({token: least}):
        wrong = "does not hold with the least constant found"
    else:
        return []
    return [f"{token.place}: {text}: '{claim.name}' {wrong}"]


def main():
    complaints, proved = own_tests.complaints(), 0
    print(f"  {'claim':29} {'in':18} {'margin':45} {'constant':>12} {'least':>12}  room")
    for title, module in TABLES.items():
        print(f"{title}:")
        for claim in module.claims():
            lacking = claim.lacking()
            for what, lacks in lacking:
                place = f"{claim.function}: a margin of '{claim.name}' is too small"
                complaints.append(f"{place}: {what}: it lacks {str(lacks)[:400]}")
            if not lacking:
                proved += 1
                complaints += [complaint for constant in claim.constants for complaint in report(claim, *constant)]
    print(f"{proved} claims proved")
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except SourceError as error:
        sys.exit(f"a claim does not understand the sources any more: {error}")
