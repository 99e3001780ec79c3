#!/usr/bin/env python3
"""Measures a medium between two robots with numbered datagrams of 1000 bytes (Ethernet header included).

    probe.py send BEGIN SECONDS ADDRESS KBIT_PER_S
    probe.py receive BEGIN SECONDS     prints what came: JSON, delays in ms, shares in %

Both ends must have the same clock: BEGIN is in s since 1970. The rate is that of what arrived while datagrams were
sent, without the first second, in which a queue fills.
"""

import json
import socket
import statistics
import struct
import sys
import time

PORT = 9000
WIRE_BYTES = 1000
HEADERS = 14 + 20 + 8  # Ethernet, IPv4, UDP
LONGEST_DELAY = 4  # s
STAMP = struct.Struct("!Qd")  # number, time of sending


def send(begin, seconds, address, kbit_per_s):
    end = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    interval = WIRE_BYTES * 8 / (kbit_per_s * 1000)
    for number in range(int(seconds / interval)):
        time.sleep(max(begin + number * interval - time.time(), 0))
        end.sendto(STAMP.pack(number, time.time()).ljust(WIRE_BYTES - HEADERS, b"\0"), (address, PORT))


def receive(begin, seconds):
    end = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    end.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
    end.bind(("", PORT))
    until = begin + seconds + LONGEST_DELAY
    numbers, delays, times = [], [], []
    while (left := until - time.time()) > 0:
        end.settimeout(left)
        try:
            data = end.recv(2048)
        except socket.timeout:
            break
        number, sent = STAMP.unpack_from(data)
        times.append(time.time())
        numbers.append(number)
        delays.append((times[-1] - sent) * 1000)
    in_time = sum(begin + 1 <= when < begin + seconds for when in times)
    return {"kbit_s": round(in_time * WIRE_BYTES * 8 / (seconds - 1) / 1000), **summary(numbers, delays)}


def summary(numbers, delays):
    if not numbers:
        return {"received": 0}
    distinct = len(set(numbers))
    overtaken, highest = 0, -1
    for number in numbers:
        overtaken += number < highest
        highest = max(highest, number)
    return {
        "received": len(numbers),
        "lost": round(100 * (1 - distinct / (highest + 1)), 1),
        "doubled": round(100 * (len(numbers) - distinct) / distinct, 1),
        "overtaken": round(100 * overtaken / len(numbers), 1),
        "delay_min": round(min(delays)),
        "delay_median": round(statistics.median(delays)),
        "delay_max": round(max(delays)),
    }


match sys.argv[1:]:
    case ["send", begin, seconds, address, kbit_per_s]:
        send(float(begin), float(seconds), address, float(kbit_per_s))
    case ["receive", begin, seconds]:
        print(json.dumps(receive(float(begin), float(seconds))))
    case _:
        sys.exit(__doc__)
