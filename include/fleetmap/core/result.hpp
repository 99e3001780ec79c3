#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace fleetmap {

/// What can fail in the field fails with a value that a person can act on.
struct Error {
  /// What is wrong, where, and what to do about it: "out/r1/store.db: disk is full; free space and start
  /// again".
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

inline tl::unexpected<Error> failure(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message)});
}

}  // namespace fleetmap
