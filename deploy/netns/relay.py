#!/usr/bin/env python3
"""Forwards frames from one interface to another and loses, delays, reorders or doubles some: for kernels without netem.

    relay.py FROM TO [--both] [--to-mac MAC] [--loss PERCENT] [--duplicate PERCENT]
                     [--delay MS] [--jitter MS] [--damage PERCENT] [--seed N] [--block SOURCE,DESTINATION]...
                     [--trace FILE --link LINK --names NAME=ADDRESS,...]

--both      also from TO to FROM
--to-mac    puts this destination address on what it forwards (FROM and TO are then ends of routes, not of a bridge)
--jitter    each datagram waits up to so many ms more, so that datagrams overtake each other
--damage    flips a bit in the second half of so many of the datagrams of more than 1000 bytes
--block     loses all from SOURCE to DESTINATION; * is any address
--trace     what each pair of robots had in the field, as docs/reference/experiments.md says: of that link, beginning with
            SIGUSR1, so many s after the file's first row (--trace-from); loss and delay are then the trace's

Only IPv4 UDP is lost, delayed or doubled. UDP checksums are set to "none", since veth leaves them to a card that is
not there.
"""

import argparse
import csv
import errno
import heapq
import random
import select
import signal
import socket
import sys
import time

import link_trace

ETH_P_ALL = 3
PACKET_OUTGOING = 4
IPV4 = b"\x08\x00"


def parse():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("source")
    parser.add_argument("sink")
    parser.add_argument("--both", action="store_true")
    parser.add_argument("--to-mac")
    for name in ("--loss", "--duplicate", "--delay", "--jitter", "--damage"):
        parser.add_argument(name, type=float, default=0.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--trace-from", type=float, default=0.0)
    parser.add_argument("--block", action="append", default=[])
    for name in ("--trace", "--link", "--names"):
        parser.add_argument(name)
    return parser.parse_args()


def open_interface(name):
    end = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ETH_P_ALL))
    end.bind((name, 0))
    end.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
    return end


def is_udp(frame):
    return frame[12:14] == IPV4 and frame[23] == socket.IPPROTO_UDP


def without_checksum(frame):
    if int.from_bytes(frame[20:22], "big") & 0x1FFF:  # a later IP fragment has no UDP header
        return frame
    at = 14 + 4 * (frame[14] & 15) + 6
    return frame[:at] + b"\0\0" + frame[at + 2 :]


def damaged(frame):
    at = random.randrange(len(frame) // 2, len(frame))
    return frame[:at] + bytes([frame[at] ^ 1 << random.randrange(8)]) + frame[at + 1 :]


class Relay:
    def __init__(self, options):
        self.options = options
        self.blocked = [pair.split(",") for pair in options.block]
        self.mac = bytes.fromhex(options.to_mac.replace(":", "")) if options.to_mac else None
        self.waiting = []  # (when, order, socket, frame)
        self.order = 0
        self.pairs = {}  # (source, destination): their trace
        self.begun = None
        if options.trace:
            names = dict(pair.split("=") for pair in options.names.split(","))
            self.pairs = link_trace.load(options.trace, options.link, names)

    def begin(self):
        self.begun = time.monotonic()

    def traced(self, frame):
        return self.pairs.get((socket.inet_ntoa(frame[26:30]), socket.inet_ntoa(frame[30:34])))

    def is_blocked(self, frame):
        source, destination = socket.inet_ntoa(frame[26:30]), socket.inet_ntoa(frame[30:34])
        return any(s in ("*", source) and d in ("*", destination) for s, d in self.blocked)

    def take(self, frame, to):
        if self.mac:
            frame = self.mac + frame[6:]
        if not is_udp(frame):
            to.send(frame)
            return
        if self.is_blocked(frame):
            return
        now, pair = time.monotonic(), self.traced(frame)
        if pair:  # what it says takes the place of the options
            elapsed = now - self.begun if self.begun else 0.0
            passes, wait = pair.passes(len(frame), now, elapsed + self.options.trace_from)
        else:
            passes = random.random() * 100 >= self.options.loss
            wait = (self.options.delay + random.random() * self.options.jitter) / 1000
        if not passes:
            return
        frame = without_checksum(frame)
        if len(frame) > 1000 and random.random() * 100 < self.options.damage:
            frame = damaged(frame)
        for _ in range(2 if random.random() * 100 < self.options.duplicate else 1):
            self.order += 1
            heapq.heappush(self.waiting, (now + wait, self.order, to, frame))

    def send_due(self):
        while self.waiting and self.waiting[0][0] <= time.monotonic():
            _, _, to, frame = heapq.heappop(self.waiting)
            to.send(frame)

    def pause(self):
        return max(self.waiting[0][0] - time.monotonic(), 0) if self.waiting else None


def main():
    options = parse()
    random.seed(options.seed)
    ends = {open_interface(options.source): None}
    sink = open_interface(options.sink)
    ends[next(iter(ends))] = sink
    if options.both:
        ends[sink] = next(iter(ends))
    try:
        relay = Relay(options)
    except (OSError, ValueError, csv.Error) as error:
        sys.exit(f"relay: {error}")
    signal.signal(signal.SIGUSR1, lambda *_: relay.begin())
    while True:
        for end in select.select(list(ends), [], [], relay.pause())[0]:
            try:
                frame, address = end.recvfrom(65536)
            except OSError as error:
                sys.exit(None if error.errno == errno.ENETDOWN else f"relay: {error}")  # the field is being removed
            if address[2] != PACKET_OUTGOING:
                relay.take(frame, ends[end])
        relay.send_due()


main()
