#!/usr/bin/env python3
"""Copies a recording (rosbag2, sqlite3) with the header stamps of one topic moved, as of a sensor whose clock is off.

    shift_stamps.py FROM TO TOPIC SECONDS [AFTER]

AFTER: seconds from the recording's begin; earlier messages keep their stamps. When messages were received stays."""
import shutil
import sqlite3
import struct
import sys
from pathlib import Path

NS = 1_000_000_000


def moved(cdr, shift):
    order = "<" if cdr[1] == 1 else ">"
    seconds, ns = struct.unpack_from(order + "iI", cdr, 4)
    seconds, ns = divmod(seconds * NS + ns + shift, NS)
    return cdr[:4] + struct.pack(order + "iI", seconds, ns) + cdr[12:]


def main():
    if len(sys.argv) not in (5, 6):
        sys.exit(__doc__)
    source, target, topic = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    shift, after = (round(float(text) * NS) for text in (sys.argv[4], (sys.argv[5:] or ["0"])[0]))
    shutil.copytree(source, target)
    count = 0
    for file in target.glob("*.db3"):
        with sqlite3.connect(file) as bag:
            begin = bag.execute("SELECT min(timestamp) FROM messages").fetchone()[0]
            rows = bag.execute(
                "SELECT messages.id, data FROM messages JOIN topics ON topics.id = topic_id "
                "WHERE topics.name = ? AND timestamp >= ?", (topic, begin + after)).fetchall()
            bag.executemany("UPDATE messages SET data = ? WHERE id = ?",
                            ((moved(data, shift), row) for row, data in rows))
            count += len(rows)
    if count == 0:
        sys.exit(f"{source}: no message of {topic}")


main()
