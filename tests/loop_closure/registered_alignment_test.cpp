#include "fleetmap/loop_closure/registered_alignment.hpp"

#include <gtest/gtest.h>

namespace fleetmap::loop_closure {
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

TEST(RegisteredAlignment, AmbiguousStaysAmbiguousThoughEachAlternativeIsUnlikely) {
  EXPECT_EQ(modes_sent({0.9985, 0.0005, 0.0005, 0.0005}), 2u);
}

TEST(RegisteredAlignment, UnlikelyAlternativesAreNotSent) {
  EXPECT_EQ(modes_sent({0.6, 0.399, 0.0005, 0.0005}), 2u);
  EXPECT_EQ(modes_sent({0.5, 0.3, 0.2}), 3u);
}

/// Two lanes that are 42 m apart see the rows between them from two sides, and all their alignments err
/// alike.
TEST(RegisteredAlignment, DistanceOfLanesFarApartIsUncertain) {
  const AgentId r1 = AgentId::parse("r1").value();
  registration::RegistrationResult result;
  result.verdict = registration::Verdict::accepted;
  result.covariance = 1e-4 * Matrix6d::Identity();
  const auto of = [&](double distance) {
    result.T_target_source.translation().y() = distance;
    return alignment_of({r1, 1}, {r1, 200}, r1, result).best().covariance;
  };
  EXPECT_EQ(of(20.0), result.covariance);
  EXPECT_GT(of(42.0)(1, 1), 30 * 0.05 * 0.05) << "thirty of them are no better than 5 cm together";
  EXPECT_EQ(of(42.0)(2, 2), 1e-4) << "height";
  EXPECT_EQ(of(42.0)(5, 5), 1e-4) << "and heading are as good as ever";
}

}  // namespace
}  // namespace fleetmap::loop_closure
