# SPDX-License-Identifier: AGPL-3.0-or-later
"""Makes oracle_rows.csv: what an independent model of the injection says of 260 syringes.

    python3 tests/haptics/plunger/make_oracle_rows.py FOLDER_OF_THE_MODEL

The folder has the model as injection.py (simulate, gh_pv, general_drop); the test that reads the rows needs
neither. 200 thin liquids run through its explicit integrator with two steps and are extrapolated to none; 60 that
thin by shear have its steady drop in a bore. Needles, barrels, friction, air, places, leaks and thumbs are drawn
with a fixed seed within what the plunger is meant for (docs/injection.md). SI.
"""

import math
import random
import sys
from pathlib import Path

THIN, THINNING = 200, 60
GAUGES = (18, 19, 20, 21, 22, 23, 25, 27)
BARRELS = {1: (1.5, 1.0), 2.5: (2.5, 1.7), 5: (3.0, 2.0), 10: (4.0, 2.7), 20: (5.0, 3.5), 50: (7.0, 5.0)}
OPEN, CAVITY, SPLIT = 0, 1, 2
INPUTS = ("diameter break_loose glide compliance air bore length viscosity infinite relaxation power entry_loss kind opening "
          "resistance rest stiffness slack toe peak peak_volume leak_opening leak_resistance force slope tremor pace spring "
          "lead speed").split()
OUTPUTS = "time travel volume flow pressure force".split()


def log_uniform(random_, low, high):
    return math.exp(random_.uniform(math.log(low), math.log(high)))


def syringe(model, random_):
    barrel = random_.choice(sorted(BARRELS))
    gauge = random_.choice(GAUGES)
    break_loose, glide = BARRELS[barrel]
    return {
        "diameter": model.BARREL[barrel], "break_loose": break_loose * random_.uniform(0.8, 1.2), "glide": glide * random_.uniform(0.5, 0.95),
        "compliance": log_uniform(random_, 0.5e-12, 1e-11), "air": random_.choice((0, 0, random_.uniform(0, 0.5e-6))),
        "bore": model.ID[gauge], "length": random_.uniform(0.016, 0.12), "viscosity": log_uniform(random_, 0.8e-3, 20e-3),
        "infinite": 0, "relaxation": 0, "power": 1, "entry_loss": random_.choice((0, 1.5, 2.2)), "kind": OPEN, "opening": 0,
        "resistance": random_.choice((0, log_uniform(random_, 1e9, 1e11))), "rest": 0, "stiffness": 0, "slack": 0, "toe": 0, "peak": 0,
        "peak_volume": 1, "leak_opening": 0, "leak_resistance": 0, "force": 0, "slope": 0, "tremor": 0, "pace": 0, "spring": 0,
        "lead": 0, "speed": 0,
    }


def add_place(case, random_):
    case["kind"] = random_.choice((OPEN, CAVITY, CAVITY, SPLIT))
    if case["kind"] == OPEN:
        case["rest"] = random_.choice((0, 1.5e3, 14e3, log_uniform(random_, 1e3, 1e5)))
    elif case["kind"] == CAVITY:
        case["rest"] = random_.uniform(0, 5e3)
        case["opening"] = random_.choice((0, random_.uniform(1e3, 5e3)))
        case["stiffness"] = log_uniform(random_, 2e8, 3e10)
        case["slack"] = random_.choice((0, random_.uniform(0, 0.3e-6)))
        case["toe"] = random_.choice((0, random_.uniform(0.05e-6, 1e-6)))
        if random_.random() < 0.3:
            case["leak_opening"] = case["rest"] + random_.uniform(0, 20e3)
            case["leak_resistance"] = log_uniform(random_, 1e10, 1e12)
    else:
        case["opening"] = log_uniform(random_, 2e3, 1e5)
        case["peak"] = case["opening"] * random_.uniform(1.1, 2.5)
        case["peak_volume"] = log_uniform(random_, 0.02e-6, 0.5e-6)


def add_thumb(case, random_, area, softness):
    top = max(case["peak"], case["rest"] + case["opening"])
    pressure = top + log_uniform(random_, 5e3, 2e5)
    force = max(case["glide"] + area * pressure, 1.1 * case["break_loose"])
    kind = random_.choice(("force", "ramp", "tremor", "rate"))
    if kind == "rate":
        case["spring"] = min(2000, 0.15 * area * area / softness)
        case["lead"] = force / case["spring"]
        case["speed"] = log_uniform(random_, 0.02e-6, 0.3e-6) / area
        return force + case["spring"] * case["speed"] * 2
    case["force"] = force
    if kind == "ramp":
        case["force"] = 0.5 * case["break_loose"]
        case["slope"] = force
    if kind == "tremor":  # so little that the stopper never slides back
        case["tremor"] = random_.uniform(0.1, 0.35) * (case["break_loose"] + case["glide"])
        case["pace"] = random_.uniform(2, 20)
    return force * 2 + case["tremor"]


def make_case(model, random_):
    while True:
        case = syringe(model, random_)
        add_place(case, random_)
        area = math.pi * case["diameter"] ** 2 / 4
        softness = case["compliance"] + case["air"] / 101325
        if add_thumb(case, random_, area, softness) < 90:
            return case


def place_of(model, case):
    if case["kind"] == OPEN:
        return lambda v: case["rest"]
    if case["kind"] == SPLIT:
        def split(v):
            if v <= case["peak_volume"]:
                return case["opening"] + (case["peak"] - case["opening"]) * v / case["peak_volume"]
            return case["peak"] * (v / case["peak_volume"]) ** -0.2
        return split
    ml = 1e6
    return lambda v: model.MMHG * model.gh_pv(v * ml, case["stiffness"] / ml / model.MMHG, case["slack"] * ml,
                                              case["rest"] / model.MMHG, case["toe"] * ml)


def run(model, case, seconds, dt):
    """The model with this step; the thumb's spring looks at the model's own stroke."""
    area = math.pi * case["diameter"] ** 2 / 4
    softness = case["compliance"] + case["air"] / 101325
    friction = [case["break_loose"], case["glide"]]
    forces = []

    def led(t, now):
        """The spring's force at the step's end: while the stopper glides it follows at once, as in a body without mass."""
        at_rest = case["spring"] * (case["lead"] + case["speed"] * t - now["x"])
        loose = at_rest - area * now["ps"] > case["break_loose"]
        friction[0] = -math.inf if loose else case["break_loose"]
        if not (loose or now["moving"]):
            return at_rest
        soft = case["spring"] * softness / area
        return (at_rest + soft * (case["glide"] / area + now["ps"]) - case["spring"] * now.get("q", 0) * dt / area) / (1 + soft / area)

    def force(t):
        f = case["force"] + case["slope"] * t + case["tremor"] * math.sin(case["pace"] * t)
        if case["spring"]:
            f = led(t, sys._getframe(1).f_locals)
        forces.append(f)
        return f

    leak = None
    if case["leak_resistance"]:
        leak = lambda p: max(0.0, p - case["leak_opening"]) / case["leak_resistance"]
    # No place gives what was not put in: it opens once the pressure is over its own.
    shut = 1e-9 if case["kind"] == SPLIT else max(case["opening"], 1e-9)
    out = model.simulate(force, area, (case["bore"], case["length"]), case["viscosity"], place_of(model, case), seconds, dt=dt,
                         rt=case["resistance"], p_open=shut, leak=leak, fric=friction, cs=softness, k_kin=case["entry_loss"])
    rows = []
    for share in (0.25, 0.5, 1):
        i = int(round(share * seconds / dt)) - 1
        rows.append([out[i, 0], out[i, 1], out[i, 2], out[i, 3], out[i, 4], forces[i]])
    return rows


def thin_rows(model, case, random_):
    seconds = random_.choice((1, 2))
    softness = case["compliance"] + case["air"] / 101325
    tau = model.resistance(case["bore"], case["length"], case["viscosity"]) * softness
    steps = math.ceil(seconds / min(2e-5, tau / 40) / 8) * 8
    coarse = run(model, case, seconds, 2 * seconds / steps)
    fine = run(model, case, seconds, seconds / steps)
    return [[f[0]] + [2 * a - b for a, b in zip(f[1:], c[1:])] for f, c in zip(fine, coarse)]


def thinning_rows(model, random_):
    """A liquid that thins, at a constant force into a constant pressure: its flow is that of the steady drop."""
    while True:
        case = syringe(model, random_)
        case.update(viscosity=log_uniform(random_, 0.1, 200), infinite=1e-3, relaxation=log_uniform(random_, 0.01, 30),
                    power=random_.uniform(0.25, 0.9), entry_loss=0, resistance=0, rest=random_.choice((0, 1e3, 20e3)))
        area = math.pi * case["diameter"] ** 2 / 4
        flow = log_uniform(random_, 0.01e-6, 0.5e-6)
        law = lambda g: model.carreau(g, case["viscosity"], case["relaxation"], case["power"]) * g
        pressure = case["rest"] + model.general_drop(flow, case["bore"], case["length"], law)
        case["force"] = case["glide"] + area * pressure
        if 1.05 * case["break_loose"] < case["force"] < 90:
            break
    softness = case["compliance"] + case["air"] / 101325
    return case, [[t, (softness * pressure + flow * t) / area, flow * t, flow, pressure, case["force"]] for t in (0.5, 1, 2)]


def main():
    sys.path.insert(0, sys.argv[1])
    import injection as model
    random_ = random.Random(16)
    lines = [",".join(INPUTS + [name + str(k) for k in range(3) for name in OUTPUTS])]
    for number in range(THIN + THINNING):
        if number < THIN:
            case = make_case(model, random_)
            rows = thin_rows(model, case, random_)
        else:
            case, rows = thinning_rows(model, random_)
        values = [case[name] for name in INPUTS] + [value for row in rows for value in row]
        lines.append(",".join(f"{value:.9g}" for value in values))
    (Path(__file__).parent / "oracle_rows.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
