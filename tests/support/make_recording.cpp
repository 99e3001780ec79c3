// Writes the generated two-robot recording into a folder: what the demo shows where no real recording is at
// hand.
#include <iostream>

#include "generated_fleet.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_recording FOLDER\n";
    return 2;
  }
  const auto fleet = fleetmap::testing::write_generated_fleet(argv[1]);
  if (!fleet) {
    std::cerr << fleet.error().message << '\n';
    return 1;
  }
  std::cout << argv[1] << ": recordings r1 and r2\n";
  return 0;
}
