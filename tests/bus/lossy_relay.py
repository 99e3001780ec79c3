"""Forwards Ethernet frames between two interfaces and loses some: lossy_relay.py IFACE IFACE LOSS_PERCENT.

For kernels without netem. UDP checksums are set to "none", since veth leaves them to a card that is not there.
"""

import random
import select
import socket
import sys

ETH_P_ALL = 3
PACKET_OUTGOING = 4


def main() -> None:
    loss = float(sys.argv[3]) / 100.0
    random.seed(1)
    ends = []
    for name in sys.argv[1:3]:
        end = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ETH_P_ALL))
        end.bind((name, 0))
        end.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
        ends.append(end)
    other = {ends[0]: ends[1], ends[1]: ends[0]}
    while True:
        for end in select.select(ends, [], [])[0]:
            frame, address = end.recvfrom(65536)
            if address[2] == PACKET_OUTGOING:
                continue
            is_udp = frame[12:14] == b"\x08\x00" and frame[23] == socket.IPPROTO_UDP
            if is_udp:
                if random.random() < loss:
                    continue
                if int.from_bytes(frame[20:22], "big") & 0x1FFF:  # a later IP fragment has no UDP header
                    other[end].send(frame)
                    continue
                at = 14 + 4 * (frame[14] & 15) + 6
                frame = frame[:at] + b"\0\0" + frame[at + 2 :]
            other[end].send(frame)


main()
