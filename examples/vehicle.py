"""The vehicle of domains/av, built from Python objects instead of HDDL, and its plans for three agents.

Usage: python examples/vehicle.py
"""

from __future__ import annotations

import statehtn
from statehtn import Attitude, chance, equal, when


def vehicle() -> statehtn.Problem:
    """Return the problem of domains/av/domain.hddl and p1.hddl: roads with jams, a school, and ice. Costs are hours."""
    build = statehtn.ProblemBuilder("p1", domain="autonomous-vehicle")
    location = build.type("location")
    frm, to, here, at_, nxt, place = location.variables("from", "to", "here", "at", "next", "place")

    road, slippery = build.predicate("road", frm, to), build.predicate("slippery", frm, to)
    incident, moving = build.predicate("incident", at_), build.predicate("moving", at_)
    destination, night = build.predicate("destination", to), build.predicate("night")
    at, visited = build.predicate("at", here), build.predicate("visited", place)
    running, lights_on, esp = (build.predicate(name) for name in ("running", "lights-on", "esp-active"))
    free, jam, p_jam, ice = (build.function(n, frm, to) for n in ("free-time", "jam-time", "p-jam", "ice-length"))
    dodging, short, long, p_long = (
        build.function(n, at_) for n in ("dodge-time", "short-wait", "long-wait", "p-long-wait")
    )

    # Tasks, and actions with their uncertain costs.
    travel, navigate = build.task("travel", frm, to), build.task("navigate", here, to)
    drive, cover = build.task("drive", here, nxt), build.task("cover", here, nxt)
    lights, handle = build.task("see-and-be-seen"), build.task("handle-incident", at_)

    start = build.action("start", precondition=~running(), effects=running(), cost=0.5)
    turn_on = build.action("turn-on-lights", precondition=running() & ~lights_on(), effects=lights_on(), cost=0.1)
    drives = running() & at(frm) & road(frm, to)
    moves = [~at(frm), at(to), visited(to), ~esp()]
    traffic = when(~slippery(frm, to), chance((1 - p_jam(frm, to), free(frm, to)), (p_jam(frm, to), jam(frm, to))))
    stable, unstable = slippery(frm, to) & esp(), slippery(frm, to) & ~esp()
    length = ice(frm, to)
    # (1 * length, as the HDDL has it: the two problems are equal, and a test says so.)
    fast = [when(stable, chance((0.2, 1 * length), (0.8, 11 * length)))]
    fast += [when(unstable, chance((0.1, 0.5 * length), (0.9, 16 * length)))]
    slow = [when(stable, 9 * length), when(unstable, chance((0.2, 6 * length), (0.8, 11 * length)))]
    accelerate = build.action("accelerate", [frm, to], precondition=drives, effects=moves, cost=[traffic, *fast])
    decelerate = build.action("decelerate", [frm, to], precondition=drives, effects=moves, cost=[traffic, *slow])
    activate = build.action("activate-esp", precondition=running() & ~esp(), effects=esp(), cost=1)
    dodge = build.action("dodge", [at_], precondition=running() & at(at_) & incident(at_), cost=dodging(at_))
    waits = chance((1 - p_long(at_), short(at_)), (p_long(at_), long(at_)))
    brake = build.action("brake", [at_], precondition=running() & at(at_) & incident(at_) & moving(at_), cost=waits)
    stop = build.action("stop", precondition=running(), effects=~running(), cost=0.4)

    # Methods: their subtasks are done in the order in which they stand.
    build.method("travel", travel(frm, to), [start(), lights(), navigate(frm, to), stop()])
    build.method("lights-at-night", lights(), turn_on(), precondition=night() & ~lights_on())
    build.method("lights-are-on", lights(), precondition=night() & lights_on())
    build.method("no-lights-by-day", lights(), precondition=~night())
    build.method("arrive", navigate(to, to), precondition=destination(to))
    unseen = destination(to) & road(here, nxt) & ~equal(here, to) & ~visited(nxt)
    onward = [drive(here, nxt), navigate(nxt, to)]
    build.method("take-road", navigate(here, to), onward, parameters=[here, nxt, to], precondition=unseen)
    build.method("drive", drive(here, nxt), [cover(here, nxt), handle(nxt)], precondition=road(here, nxt))
    dry, on_ice = road(here, nxt) & ~slippery(here, nxt), slippery(here, nxt)
    boldly, carefully = accelerate(here, nxt), decelerate(here, nxt)
    build.method("cover-clear-road", cover(here, nxt), boldly, precondition=dry & ~incident(nxt))
    build.method("approach-incident", cover(here, nxt), carefully, precondition=dry & incident(nxt))
    build.method("ignore-the-ice", cover(here, nxt), boldly, precondition=on_ice)
    build.method("slow-down-on-ice", cover(here, nxt), carefully, precondition=on_ice)
    build.method("trust-esp", cover(here, nxt), [activate(), boldly], precondition=on_ice)
    build.method("slow-down-with-esp", cover(here, nxt), [activate(), carefully], precondition=on_ice)
    build.method("nothing-in-the-way", handle(at_), precondition=~incident(at_))
    build.method("dodge-what-stands", handle(at_), dodge(at_), precondition=incident(at_) & ~moving(at_))
    build.method("brake-for-what-moves", handle(at_), brake(at_), precondition=incident(at_) & moving(at_))

    # The map, and the journey.
    s, l1, l2, l3, l4, l5, e = location.objects("s", "l1", "l2", "l3", "l4", "l5", "e")
    build.initially(at(s), visited(s), destination(e), night(), incident(l2), incident(l5), moving(l5))
    hours = [(s, l1, 4, 4, 0), (s, l3, 2, 6, 0.2), (l1, l3, 2, 8, 0.1), (l3, l1, 2, 8, 0.1), (l1, l2, 0.4, 0.4, 0)]
    hours += [(l2, l4, 3, 3, 0), (l3, l5, 0.5, 3, 0.1), (l5, l4, 1, 3.5, 0.2)]
    for a, b, in_free_traffic, in_a_jam, probability in hours:
        build.initially(road(a, b))
        build.set_values({free(a, b): in_free_traffic, jam(a, b): in_a_jam, p_jam(a, b): probability})
    build.initially(road(l4, e), slippery(l4, e))
    build.set_values({ice(l4, e): 1, dodging(l2): 1, short(l5): 0.5, long(l5): 2.5, p_long(l5): 0.9})
    build.set_network(travel(s, e))
    return build.build()


if __name__ == "__main__":
    problem = vehicle()
    for attitude in (Attitude.AVERSE, Attitude.NEUTRAL, Attitude.SEEKING):
        alpha = None if attitude is Attitude.NEUTRAL else 0.9
        print(f"{attitude}:\n{statehtn.plan(problem, attitude=attitude, alpha=alpha)}\n")
