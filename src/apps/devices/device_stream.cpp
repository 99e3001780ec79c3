#include "device_stream.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>
#include <variant>

#include "udp_socket.hpp"

namespace fleetmap::apps {
namespace {

using agent::SerialPort, agent::TcpServer, agent::UdpPort;

constexpr int kPollMilliseconds = 100;
constexpr timeval kConnectTimeout{2, 0};

/// A descriptor, or the reason why there is none.
using Opened = tl::expected<int, std::string>;

tl::unexpected<std::string> refused(int descriptor, std::string reason) {
  if (descriptor >= 0) ::close(descriptor);
  return tl::unexpected(std::move(reason));
}
tl::unexpected<std::string> refused(int descriptor) { return refused(descriptor, std::strerror(errno)); }

speed_t speed_of(std::uint32_t baud) {
  switch (baud) {
    case 4800:
      return B4800;
    case 19200:
      return B19200;
    case 38400:
      return B38400;
    case 57600:
      return B57600;
    case 115200:
      return B115200;
    case 230400:
      return B230400;
    case 460800:
      return B460800;
    case 921600:
      return B921600;
    case 1000000:
      return B1000000;
    default:
      return B9600;
  }
}

Opened open_place(const SerialPort& serial) {
  const int descriptor = ::open(serial.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    if (errno == EACCES) return refused(descriptor, "permission denied; add the user to the group dialout");
    if (errno == ENOENT) return refused(descriptor, "no such device; plug it in, or correct the path");
    return refused(descriptor);
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0)
    return refused(descriptor, "another program reads it; end that one");
  termios settings{};
  if (::tcgetattr(descriptor, &settings) != 0) return refused(descriptor, "is no serial port");
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  ::cfsetspeed(&settings, speed_of(serial.baud));
  if (::tcsetattr(descriptor, TCSANOW, &settings) != 0) return refused(descriptor);
  ::tcflush(descriptor, TCIFLUSH);  // what waited came at an unknown time
  return descriptor;
}

Opened open_place(const UdpPort& udp) {
  const auto socket = open_udp_socket(udp.port);
  if (socket) return *socket;
  if (socket.error() == std::errc::address_in_use)
    return refused(-1, "another program receives there; end that one");
  return refused(-1, socket.error().message());
}

Opened open_place(const TcpServer& server) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(server.host.c_str(), std::to_string(server.port).c_str(), &wanted, &found);
  if (error != 0) return refused(-1, ::gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, &::freeaddrinfo);
  std::string reason = "no address";
  for (const addrinfo* address = found; address != nullptr; address = address->ai_next) {
    const int descriptor =
        ::socket(address->ai_family, address->ai_socktype | SOCK_CLOEXEC, address->ai_protocol);
    ::setsockopt(descriptor, SOL_SOCKET, SO_SNDTIMEO, &kConnectTimeout, sizeof kConnectTimeout);
    if (descriptor >= 0 && ::connect(descriptor, address->ai_addr, address->ai_addrlen) == 0) {
      ::fcntl(descriptor, F_SETFL, O_NONBLOCK);
      return descriptor;
    }
    reason = std::strerror(errno);
    if (descriptor >= 0) ::close(descriptor);
  }
  return refused(-1, reason + "; start it, or correct host and port");
}

}  // namespace

Result<DeviceStream> DeviceStream::open(const agent::DevicePlace& place) {
  const Opened opened = std::visit([](const auto& one) { return open_place(one); }, place);
  if (!opened) return failure(to_string(place) + ": " + opened.error());
  return DeviceStream(*opened, place);
}

DeviceStream::DeviceStream(int descriptor, const agent::DevicePlace& place)
    : descriptor_(descriptor), name_(to_string(place)), is_udp_(std::holds_alternative<UdpPort>(place)) {}

DeviceStream::DeviceStream(DeviceStream&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      name_(std::move(other.name_)),
      is_udp_(other.is_udp_),
      sender_(other.sender_) {}

DeviceStream::~DeviceStream() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

tl::unexpected<Error> DeviceStream::failed(const std::string& reason) const {
  return failure(name_ + ": " + reason);
}

Result<std::size_t> DeviceStream::read(std::span<std::uint8_t> buffer) {
  pollfd ready{descriptor_, POLLIN, 0};
  const int polled = ::poll(&ready, 1, kPollMilliseconds);
  if (polled < 0 && errno != EINTR) return failed(std::strerror(errno));
  if (polled <= 0) return std::size_t{0};
  sockaddr_in sender{};
  socklen_t length = sizeof sender;
  const ssize_t size = is_udp_ ? ::recvfrom(descriptor_, buffer.data(), buffer.size(), 0,
                                            reinterpret_cast<sockaddr*>(&sender), &length)
                               : ::read(descriptor_, buffer.data(), buffer.size());
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return std::size_t{0};
  if (size < 0) return failed("the device is gone (" + std::string(std::strerror(errno)) + ")");
  if (is_udp_) {
    sender_ = sender;
  } else if (size == 0) {
    return failed("the device is gone");
  }
  return static_cast<std::size_t>(size);
}

Status DeviceStream::write(ByteView bytes) {
  if (is_udp_ && !sender_) return {};
  const ssize_t written = is_udp_ ? ::sendto(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL,
                                             reinterpret_cast<const sockaddr*>(&*sender_), sizeof *sender_)
                                  : ::write(descriptor_, bytes.data(), bytes.size());
  if (written >= 0 || errno == EAGAIN || errno == EINTR || is_udp_) return {};
  return failed("the device is gone (" + std::string(std::strerror(errno)) + ")");
}

std::uint16_t DeviceStream::port() const { return udp_port_of(descriptor_); }

}  // namespace fleetmap::apps
