#pragma once

#include "fleetmap/trust/introduction.hpp"
#include "radio_link.hpp"

namespace fleetmap::bus {

/// Seals and checks the Hellos of a fleet with keys. A robot becomes a peer once it has answered the
/// challenge of this start, so that a recorded Hello of another day is answered and has no other effect. All
/// calls are made with the link's mutex held.
class RadioLink::Greetings {
 public:
  explicit Greetings(RadioLink& radio) : radio_(radio) {}

  Bytes greeting_of(const Hello& hello, const RemoteLocator& remote) const;
  void on_greeting(const Prefix& sender, const Bytes& greeting);
  void report_strangers();

 private:
  void answer_claim(const Prefix& sender, const Locator& from, const trust::Introduction& introduction);
  bool prove(const Prefix& sender, const Locator& from, const Hello& hello,
             const trust::Introduction& introduction);

  RadioLink& radio_;
};

}  // namespace fleetmap::bus
