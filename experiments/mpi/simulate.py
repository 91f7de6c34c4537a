"""Predicts the gain of more processes: simulates the schedule of src/mpi/leader.cpp with the seconds and
bytes of a log (TROFFER_MPI_JOURNAL=FILE mpirun … troffer render …). Every process has one thread and
a core of its own.

  simulate.py JOURNAL [--latency S] [--bandwidth BYTES_PER_S] [--pixels N] [--rays N]
              [PROCESSES …]
"""
import argparse
import heapq
import json
import math


class Net:
    """latency: seconds from one process to another, including wake-up; bandwidth: bytes per second of
    each process's link; letter: rank 0's seconds for a message, an answer and the next lease."""

    def __init__(self, latency, bandwidth, letter):
        self.latency, self.bandwidth, self.letter = latency, bandwidth, letter


def goes_by_pixels(records):
    """Tells for each job if its size follows the pixels: tiles and gathers do, cells hardly."""
    gathers = [r["items"] for r in records if r["for_all"] and r["items"]][-1:]
    has_gathers = sum([r["items"]] == gathers for r in records if r["for_all"]) > 2
    return [r["items"] > 0 and (not r["for_all"] or (has_gathers and [r["items"]] == gathers))
            for r in records]


class Job:
    def __init__(self, record, repeat, costs):
        self.seconds = [s * costs for s in record["seconds"] if s > 0] * repeat
        letters = max(record["messages"], 1)
        self.brief = record["brief_bytes"] / letters
        self.answer = record["answer_bytes"] / letters
        self.told = record["sent_bytes"] * repeat
        self.before = record["before"] * repeat

    def handed_out(self, processes, net):
        """Returns seconds until the last answer, and rank 0's seconds for messages."""
        if processes == 1 or not self.seconds:
            return sum(self.seconds), 0.0
        left = list(reversed(self.seconds))
        cost = net.letter + (self.brief + self.answer) / net.bandwidth
        there = net.latency + self.brief / net.bandwidth
        back = net.latency + self.answer / net.bandwidth
        waiting = [[] for _ in range(processes)]  # (time of arrival, its seconds)
        free_at = [0.0] * processes
        # An event is an answer that rank 0 gets, or the end of an item of rank 0. All others begin
        # with two items: one to do, and one that waits.
        events = [(net.latency, r) for r in range(1, processes)] * 2 + [(0.0, 0)]
        heapq.heapify(events)
        courier = busy = end = 0.0
        while events:
            t, r = heapq.heappop(events)
            end = max(end, t)
            if r == 0:
                if left:
                    heapq.heappush(events, (t + left.pop(), 0))
                continue
            courier = max(courier, t) + cost
            busy += cost
            if not left:
                continue
            begins = max(courier + there, free_at[r])
            free_at[r] = begins + left.pop()
            heapq.heappush(events, (free_at[r] + back, r))
        return end, busy

    def spread(self, processes, net):
        """Returns seconds until all know the result, along a binomial tree in pieces of 8 MiB."""
        if processes == 1:
            return 0.0
        depth = math.ceil(math.log2(processes))
        piece = min(self.told, 8 << 20)
        # Rank 0 sends as many copies as the tree is deep.
        return depth * (net.latency + piece / net.bandwidth) + (
            self.told - piece) * depth / net.bandwidth


def simulate(jobs, processes, net):
    serial = sum(j.before for j in jobs)
    handed = busy = spread = 0.0
    for j in jobs:
        seconds, letters = j.handed_out(processes, net)
        handed += seconds
        busy += letters
        spread += j.spread(processes, net)
    return serial, handed, spread, busy


def main():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("journal")
    p.add_argument("processes", nargs="*", type=int, default=[1, 2, 4, 16, 64, 256, 1000])
    p.add_argument("--latency", type=float, default=300e-6)
    p.add_argument("--bandwidth", type=float, default=1.2e9)
    p.add_argument("--rays", type=float, default=1, help="as if each had so many times the rays")
    p.add_argument("--pixels", type=int, default=1, help="as if the picture had so many times as many")
    a = p.parse_args()
    with open(a.journal) as lines:
        records = [json.loads(line) for line in lines]
    letters = sum(r["messages"] for r in records)
    letter = sum(r["message_seconds"] for r in records) / max(letters, 1)
    net = Net(a.latency, a.bandwidth, letter)
    jobs = [Job(r, a.pixels if by_pixels else 1, a.rays)
            for r, by_pixels in zip(records, goes_by_pixels(records))]
    items = [s for j in jobs for s in j.seconds]
    alone = sum(j.before for j in jobs) + sum(items)
    answers = sum(r["answer_bytes"] + r["brief_bytes"] for r in records)
    print(f"{len(items)} items, {sum(items):.2f} s, the longest {max(items) * 1e3:.1f} ms; "
          f"each process by itself {alone - sum(items):.2f} s")
    print(f"rank 0: {letter * 1e6:.0f} us and {answers / max(letters, 1) / 1e3:.1f} kB for an item; "
          f"{sum(j.told for j in jobs) / 1e6:.1f} MB told to all")
    print("processes  seconds  own  items  telling  efficiency  Amdahl")
    for n in a.processes:
        serial, handed, spread, busy = simulate(jobs, n, net)
        total = serial + handed + spread
        amdahl = alone / n / (serial + sum(items) / n)
        print(f"{n:9} {total:8.2f} {serial:4.2f} {handed:6.2f} {spread:8.2f} "
              f"{alone / n / total:10.1%} {amdahl:7.1%}")


if __name__ == "__main__":
    main()
