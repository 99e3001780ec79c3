#!/usr/bin/env python3
"""Compares two LAS files of one map that two processors wrote: las_units.py A B. Debian's GeographicLib projects points
with the processor's own libm and fused multiplications, so a coordinate that lies on the edge of a unit (1 mm) may be
rounded either way. All else must be the same bytes, and at most one point in 10,000 differ, by one unit.
"""
import struct
import sys

MAX_SHARE = 1e-4

first, second = (open(name, "rb").read() for name in sys.argv[1:3])
offset, = struct.unpack_from("<I", first, 96)
length, = struct.unpack_from("<H", first, 105)
number, = struct.unpack_from("<Q", first, 247)  # of points, LAS 1.4
if number == 0 or len(first) != len(second) or first[:179] != second[:179] or first[227:offset] != second[227:offset]:
    sys.exit("the files differ in more than points")
scales = struct.unpack_from("<3d", first, 131)
bounds = (struct.unpack_from("<6d", one, 179) for one in (first, second))  # max x, min x, max y, ...
if any(abs(a - b) > 1.001 * scales[k // 2] for k, (a, b) in enumerate(zip(*bounds))):
    sys.exit("the bounds differ by more than one unit")
differ = 0
for at in range(offset, offset + number * length, length):
    if first[at : at + length] == second[at : at + length]:
        continue
    if first[at + 12 : at + length] != second[at + 12 : at + length]:
        sys.exit("points differ in more than their place")
    if any(abs(a - b) > 1 for a, b in zip(struct.unpack_from("<3i", first, at), struct.unpack_from("<3i", second, at))):
        sys.exit("points differ by more than one unit")
    differ += 1
if first[offset + number * length :] != second[offset + number * length :]:
    sys.exit("the files differ behind the points")
print(f"{differ} of {number} points are rounded to another unit")
sys.exit(differ > MAX_SHARE * number)
