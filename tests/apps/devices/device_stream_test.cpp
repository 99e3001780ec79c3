#include "devices/device_stream.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>

#include <array>
#include <optional>

#include "support/pseudo_terminal.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using agent::SerialPort, agent::TcpServer, agent::UdpPort;
using fleetmap::testing::PseudoTerminal;
using ::testing::HasSubstr;

constexpr int kTries = 100;  // of 0.1 s

std::string read_some(DeviceStream& stream) {
  std::array<std::uint8_t, 64> buffer{};
  for (int k = 0; k < kTries; ++k) {
    const auto size = stream.read(buffer);
    if (!size) return size.error().message;
    if (*size > 0) return {buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(*size)};
  }
  return "nothing came";
}

std::string refusal(const agent::DevicePlace& place) {
  const auto stream = DeviceStream::open(place);
  return stream ? "no error" : stream.error().message;
}

sockaddr_in here(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// A socket of this machine.
class Socket {
 public:
  explicit Socket(int type) : socket_(::socket(AF_INET, type | SOCK_CLOEXEC, 0)) {
    sockaddr_in address = here(0);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Socket() { ::close(socket_); }
  int get() const { return socket_; }
  std::uint16_t port() const {
    sockaddr_in address{};
    socklen_t length = sizeof address;
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length), 0);
    return ntohs(address.sin_port);
  }

 private:
  int socket_;
};

TEST(DeviceStream, ASerialPortHandsOnEveryByteInBothDirections) {
  const PseudoTerminal device;
  auto stream = DeviceStream::open(SerialPort{device.path(), 57600});
  ASSERT_TRUE(stream) << stream.error().message;
  EXPECT_EQ(device.speed(), static_cast<speed_t>(B57600));
  // Bytes that a terminal would take as ends of lines, interrupts and flow control.
  const std::string bytes("\x03\x04\r\n\x11\x13\x1a\xfd\xff\x00\x7f", 11);
  ASSERT_TRUE(device.send(bytes_of(bytes)));
  EXPECT_EQ(read_some(*stream), bytes);
  ASSERT_TRUE(stream->write(bytes_of(bytes)));
  const Bytes received = device.receive();
  EXPECT_EQ(std::string(received.begin(), received.end()), bytes);
}

TEST(DeviceStream, ASerialPortThatVanishesIsAnError) {
  std::optional<PseudoTerminal> device(std::in_place);
  auto stream = DeviceStream::open(SerialPort{device->path(), 57600});
  ASSERT_TRUE(stream) << stream.error().message;
  const std::string path = device->path();
  device.reset();
  EXPECT_THAT(read_some(*stream), HasSubstr(path + ": the device is gone"));
}

TEST(DeviceStream, ASecondReaderOfASerialPortIsRefused) {
  const PseudoTerminal device;
  const auto first = DeviceStream::open(SerialPort{device.path(), 57600});
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_THAT(refusal(SerialPort{device.path(), 57600}), HasSubstr("another program reads it"));
}

TEST(DeviceStream, FileThatIsNoDeviceIsNamed) {
  const fleetmap::testing::TemporaryFolder folder;
  EXPECT_THAT(refusal(SerialPort{folder.path() / "ttyACM0", 57600}),
              HasSubstr("ttyACM0: no such device; plug it in"));
  EXPECT_THAT(refusal(SerialPort{folder.write("file", "text"), 57600}), HasSubstr("file: is no serial port"));
}

TEST(DeviceStream, UdpAnswersWhoSentLast) {
  auto stream = DeviceStream::open(UdpPort{0});
  ASSERT_TRUE(stream) << stream.error().message;
  ASSERT_TRUE(stream->write(bytes_of("to nobody")));
  const Socket device(SOCK_DGRAM);
  const sockaddr_in to = here(stream->port());
  for (const std::string_view text : {"", "hello"})
    ASSERT_EQ(::sendto(device.get(), text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                       sizeof to),
              static_cast<ssize_t>(text.size()));
  EXPECT_EQ(read_some(*stream), "hello");
  ASSERT_TRUE(stream->write(bytes_of("answer")));
  std::array<char, 16> answer{};
  EXPECT_EQ(::recv(device.get(), answer.data(), answer.size(), 0), 6);
  EXPECT_STREQ(answer.data(), "answer");
  EXPECT_THAT(refusal(UdpPort{stream->port()}), HasSubstr("another program receives there"));
}

TEST(DeviceStream, ATcpServerThatEndsIsAnError) {
  const Socket server(SOCK_STREAM);
  EXPECT_THAT(refusal(TcpServer{"127.0.0.1", server.port()}),
              HasSubstr("start it, or correct host and port"));
  ASSERT_EQ(::listen(server.get(), 1), 0);
  auto stream = DeviceStream::open(TcpServer{"localhost", server.port()});
  ASSERT_TRUE(stream) << stream.error().message;
  const int connection = ::accept(server.get(), nullptr, nullptr);
  ASSERT_TRUE(stream->write(bytes_of("?WATCH")));
  std::array<char, 16> request{};
  EXPECT_EQ(::recv(connection, request.data(), request.size(), 0), 6);
  EXPECT_EQ(::send(connection, "report", 6, 0), 6);
  EXPECT_EQ(read_some(*stream), "report");
  ::close(connection);
  EXPECT_THAT(read_some(*stream), HasSubstr("the device is gone"));
}

}  // namespace
}  // namespace fleetmap::apps
