# SPDX-License-Identifier: AGPL-3.0-or-later
"""python -m artus JOINT: what is in a joint, and what its planned needles pass through."""

import sys

import artus


def main(arguments):
    if len(arguments) != 1 or arguments[0] in ("-h", "--help"):
        print(__doc__)
        return 0 if arguments[:1] in (["-h"], ["--help"]) else 2
    try:
        joint = artus.load(arguments[0])
    except (OSError, ValueError) as error:
        print(f"artus: {error}", file=sys.stderr)
        return 1
    print(f"artus {artus.__version__}: {joint.name}, {len(joint.regions)} regions")
    for number, (entry, target) in enumerate(joint.injections, 1):
        print(f"injection {number}")
        for region, first, last in artus.needle_intervals(joint, entry, target):
            print(f"  {region:28s} {1e3 * first:8.2f} .. {1e3 * last:8.2f} mm")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
