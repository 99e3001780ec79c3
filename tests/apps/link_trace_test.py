"""What deploy/netns/link_trace.py makes of a trace: run by ctest."""

import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "deploy", "netns"))
import link_trace  # noqa: E402

ADDRESSES = {"r1": "a", "r2": "b"}
COLUMNS = "time_s,link,from,to,kbit_s,ms,loss_percent\n"


def load(text, link="long_range"):
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
        file.write(text)
        file.flush()
        return link_trace.load(file.name, link, ADDRESSES)


class LinkTrace(unittest.TestCase):
    def test_rows_hold_until_the_next_of_the_pair(self):
        pair = load(COLUMNS + "100,long_range,r1,r2,,30,0\n110,long_range,r1,r2,,50,100\n120,long_range,r1,r2,,70,0\n")[("a", "b")]
        self.assertEqual(pair.passes(100, 0.0, 0.0), (True, 0.03))
        self.assertEqual(pair.passes(100, 0.0, 9.9), (True, 0.03))
        self.assertFalse(pair.passes(100, 0.0, 10.1)[0])
        self.assertEqual(pair.passes(100, 0.0, 99.0), (True, 0.07))

    def test_a_slow_link_queues_and_then_drops(self):
        pair = load(COLUMNS + "0,long_range,r1,r2,80,,\n")[("a", "b")]
        self.assertAlmostEqual(pair.passes(1000, 5.0, 0.0)[1], 0.1)
        self.assertAlmostEqual(pair.passes(1000, 5.0, 0.0)[1], 0.2)
        passed = [pair.passes(1000, 5.0, 0.0)[0] for _ in range(40)]
        self.assertTrue(passed[0] and not passed[-1])

    def test_the_difference_of_clocks_is_taken_out(self):
        rows = COLUMNS + "1,long_range,r1,r2,,620,\n1,long_range,r2,r1,,-580,\n"
        pairs = load(rows)
        self.assertAlmostEqual(pairs[("a", "b")].passes(1, 0.0, 0.0)[1], 0.02)
        self.assertAlmostEqual(pairs[("b", "a")].passes(1, 0.0, 0.0)[1], 0.02)

    def test_links_and_files_behind_each_other(self):
        rows = COLUMNS + "1,short_range,r1,r2,,5,\n" + COLUMNS + "1,long_range,r2,r1,,7,\n1,long_range,r9,r1,,7,\n"
        self.assertEqual(list(load(rows)), [("b", "a")])
        self.assertEqual(list(load(rows, "short_range")), [("a", "b")])
        self.assertEqual(list(load("time_s,from,to,loss_percent\n1,r1,r2,3\n")), [("a", "b")], "without a column link")

    def test_cut_lines_are_left_out(self):
        pair = load(COLUMNS + "1,long_range,r1,r2,,5,\n2,long_range,r1,r2,,62,long_range,r1,r2,,7,\n3,long_r\n")[("a", "b")]
        self.assertEqual(len(pair.rows), 1)

    def test_a_trace_of_other_robots_is_refused(self):
        with self.assertRaisesRegex(ValueError, "is of husky1, husky2; robots are called r1, r2 here"):
            load(COLUMNS + "1,long_range,husky1,husky2,,5,\n")

    def test_what_is_wrong_is_named(self):
        with self.assertRaisesRegex(ValueError, "has no column from"):
            load("time_s,to\n1,r1\n")
        with self.assertRaisesRegex(ValueError, ":3: ms is 'soon', expected a number"):
            load(COLUMNS + "1,long_range,r1,r2,,5,\n2,long_range,r1,r2,,soon,\n")


unittest.main()
