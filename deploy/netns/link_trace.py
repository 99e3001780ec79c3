"""Traces of links: a CSV with the columns time_s, from, to, and any of link, kbit_s, ms, loss_percent, others ignored.

A row holds from its time on, for what `from` sends to `to`, until the next row of the two. kbit_s is what the link
carries, ms how long a datagram takes, loss_percent how many do not come (100: out of reach); empty or absent: not known,
so nothing of it is imposed. `link` is long_range or short_range; without that column rows are of the long range.
Robots' own link_trace.csv are such traces; those of several robots may be put behind each other.
"""

import bisect
import csv
import random

LONGEST_QUEUE = 2.0  # s that a datagram waits for a slow link, else it is lost


class Pair:
    """What one robot sends to another."""

    def __init__(self):
        self.rows = []  # (time, kbit/s, s, loss), None: not known
        self.times = []
        self.free = 0.0  # when the link has sent what waits

    def sort(self, origin):
        self.rows.sort(key=lambda row: row[0])
        self.times = [row[0] - origin for row in self.rows]

    def passes(self, size, now, elapsed):
        """Whether a datagram of so many bytes comes through, and how many s later."""
        at = max(bisect.bisect_right(self.times, elapsed) - 1, 0)
        _, kbit_s, delay, loss = self.rows[at]
        if loss is not None and random.random() * 100 < loss:
            return False, 0.0
        later = delay or 0.0
        if kbit_s is not None:
            begins = max(self.free, now)
            if kbit_s <= 0.0 or begins - now > LONGEST_QUEUE:
                return False, 0.0
            self.free = begins + size * 8e-3 / kbit_s
            later += self.free - now
        return True, later


def is_whole(row):
    """A line that a power cut has left short, or run into the next, has other cells than the file has columns."""
    return None not in row and None not in row.values()


def number(row, column, file, line):
    text = (row.get(column) or "").strip()
    if not text:
        return None
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{file}:{line}: {column} is '{text}', expected a number") from None


def median(values):
    return sorted(values)[len(values) // 2]


def take_clocks_out(pairs):
    """Delays between two machines hold the difference of their clocks, with either sign: it is taken out."""
    for (source, destination), pair in pairs.items():
        there = [row[2] for row in pair.rows if row[2] is not None]
        other = pairs.get((destination, source))
        back = [row[2] for row in other.rows if row[2] is not None] if other and source < destination else []
        if there and back:
            ahead = (median(there) - median(back)) / 2
            pair.rows = [(t, k, d if d is None else d - ahead, p) for t, k, d, p in pair.rows]
            other.rows = [(t, k, d if d is None else d + ahead, p) for t, k, d, p in other.rows]
    for pair in pairs.values():
        pair.rows = [(t, k, d if d is None else max(d, 0.0), p) for t, k, d, p in pair.rows]


def load(file, link, addresses):
    """The pairs of robots in `addresses` (by name) on `link`, by (address, address); their time begins with 0."""
    pairs, first, strangers, known = {}, None, set(), False
    with open(file, newline="") as lines:
        reader = csv.DictReader(lines)
        for column in ("time_s", "from", "to"):
            if column not in (reader.fieldnames or []):
                raise ValueError(f"{file}: has no column {column}")
        for row in reader:
            if row["time_s"] == "time_s" or not is_whole(row):  # the next robot's file
                continue
            time = number(row, "time_s", file, reader.line_num)
            if time is None:
                raise ValueError(f"{file}:{reader.line_num}: has no time_s")
            first = time if first is None else min(first, time)
            if row["from"] not in addresses or row["to"] not in addresses:
                strangers.update({row["from"], row["to"]} - addresses.keys())
                continue
            known = True
            if (row.get("link") or "long_range") != link:
                continue
            ms = number(row, "ms", file, reader.line_num)
            pair = pairs.setdefault((addresses[row["from"]], addresses[row["to"]]), Pair())
            pair.rows.append(
                (
                    time,
                    number(row, "kbit_s", file, reader.line_num),
                    None if ms is None else ms / 1000,
                    number(row, "loss_percent", file, reader.line_num),
                )
            )
    if not known:
        raise ValueError(f"{file}: is of {', '.join(sorted(strangers)) or 'nobody'}; robots are called {', '.join(addresses)} here")
    take_clocks_out(pairs)
    for pair in pairs.values():
        pair.sort(first)
    return pairs
