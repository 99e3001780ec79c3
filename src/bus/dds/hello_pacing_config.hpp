#pragma once

namespace fleetmap::bus {

struct HelloPacingConfig {
  double fleet_bits_per_second = 0.0;  ///< of all traffic of all robots
  bool keys = false;                   ///< Hellos are sealed and signed, which takes three instead of two
  bool observes = false;               ///< joins a fleet that may be using the radio
};

}  // namespace fleetmap::bus
