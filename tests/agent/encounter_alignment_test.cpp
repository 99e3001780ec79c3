#include <gtest/gtest.h>

#include "fleetmap/agent/encounter_registration.hpp"

namespace fleetmap::agent {
namespace {

registration::RegistrationResult ambiguous(std::initializer_list<double> weights) {
  registration::RegistrationResult result;
  result.verdict = registration::Verdict::ambiguous;
  for (const double weight : weights) result.modes.emplace_back().weight = weight;
  return result;
}

std::size_t modes_sent(std::initializer_list<double> weights) {
  const AgentId r1 = AgentId::parse("r1").value(), r2 = AgentId::parse("r2").value();
  return alignment_of({r1, 1}, {r2, 1}, r1, ambiguous(weights)).modes.size();
}

TEST(EncounterAlignment, AmbiguousStaysAmbiguousThoughEachAlternativeIsUnlikely) {
  EXPECT_EQ(modes_sent({0.9985, 0.0005, 0.0005, 0.0005}), 2u);
}

TEST(EncounterAlignment, UnlikelyAlternativesAreNotSent) {
  EXPECT_EQ(modes_sent({0.6, 0.399, 0.0005, 0.0005}), 2u);
  EXPECT_EQ(modes_sent({0.5, 0.3, 0.2}), 3u);
}

}  // namespace
}  // namespace fleetmap::agent
