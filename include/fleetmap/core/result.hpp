#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace fleetmap {

/// Errors that occur in the field are values on which a person can act.
struct Error {
  /// Names the problem, its place and the remedy: "out/r1/store.db: disk is full; free space and start
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
