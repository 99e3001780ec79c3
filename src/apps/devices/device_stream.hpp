#pragma once

#include <netinet/in.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "fleetmap/agent/device_config.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::apps {

/// The open connection to a device. Errors name the place, the reason and the remedy.
class DeviceStream {
 public:
  /// A serial port becomes raw, 8N1, and is locked, since two readers would each get a part of the bytes.
  static Result<DeviceStream> open(const agent::DevicePlace& place);
  DeviceStream(DeviceStream&& other) noexcept;
  DeviceStream& operator=(DeviceStream&&) = delete;
  ~DeviceStream();

  /// The number of bytes that came within 0.1 s. An error means that the device is gone.
  Result<std::size_t> read(std::span<std::uint8_t> buffer);
  /// Over UDP the bytes go to the last sender, if there is one. Bytes that a full line does not accept are
  /// lost.
  Status write(ByteView bytes);
  /// The UDP port, also one that the system chose.
  std::uint16_t port() const;

 private:
  DeviceStream(int descriptor, const agent::DevicePlace& place);
  tl::unexpected<Error> failed(const std::string& reason) const;

  int descriptor_;
  std::string name_;
  bool is_udp_;
  std::optional<sockaddr_in> sender_;  ///< of the last datagram
};

}  // namespace fleetmap::apps
