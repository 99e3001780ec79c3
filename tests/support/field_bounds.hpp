#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

/// Checks of the bounds that a configuration's validate() sets to its fields.
namespace fleetmap::testing {

template <class T>
inline constexpr T kNaN = std::numeric_limits<T>::quiet_NaN();
template <class T>
inline constexpr T kInfinity = std::numeric_limits<T>::infinity();

/// validate() refuses `config` once `change` was made to it, and the error names `field`.
template <class Config, class Change>
void expect_refused(Config config, Change change, const std::string& field) {
  ASSERT_TRUE(config.validate()) << field << ": " << config.validate().error().message;
  change(config);
  const auto valid = config.validate();
  ASSERT_FALSE(valid) << field;
  EXPECT_NE(valid.error().message.find(field), std::string::npos) << field << ": " << valid.error().message;
}

/// validate() refuses `config` with each of the values in the field, and the error names `name`.
template <class Config, class T>
void expect_refused(const Config& config, T Config::*field,
                    std::initializer_list<std::type_identity_t<T>> values, const std::string& name) {
  for (const T& value : values) {
    SCOPED_TRACE(::testing::PrintToString(value));
    expect_refused(
        config, [&](Config& changed) { changed.*field = value; }, name);
  }
}

/// validate() accepts `config` with each of the values in the field.
template <class Config, class T>
void expect_accepted(Config config, T Config::*field, std::initializer_list<std::type_identity_t<T>> values) {
  for (const T& value : values) {
    config.*field = value;
    const auto valid = config.validate();
    EXPECT_TRUE(valid) << ::testing::PrintToString(value) << ": " << valid.error().message;
  }
}

/// Fields of a configuration, each with the name that errors give it.
template <class Config>
using NamedFields = std::initializer_list<std::pair<double Config::*, const char*>>;

/// validate() refuses `config` where any of the fields is zero, negative or not finite.
template <class Config>
void expect_positive(const Config& config, NamedFields<std::type_identity_t<Config>> fields) {
  for (const auto& [field, name] : fields)
    expect_refused(config, field, {0.0, -1.0, kNaN<double>, kInfinity<double>}, name);
}

/// validate() accepts zero in each of the fields, and refuses what is negative or not finite.
template <class Config>
void expect_not_negative(const Config& config, NamedFields<std::type_identity_t<Config>> fields) {
  for (const auto& [field, name] : fields) {
    expect_accepted(config, field, {0.0});
    expect_refused(config, field, {-0.1, kNaN<double>, kInfinity<double>}, name);
  }
}

}  // namespace fleetmap::testing
