#include "devices/udp_socket.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

namespace fleetmap::apps {
namespace {

/// A socket that is closed at the end of its test.
class UdpSocket {
 public:
  explicit UdpSocket(const UdpSocketOptions& options = {}) : socket_(open_udp_socket(0, options).value()) {}
  ~UdpSocket() { ::close(socket_); }
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  int get() const { return socket_; }
  std::uint16_t port() const { return udp_port_of(socket_); }

 private:
  int socket_;
};

void send_to(std::uint16_t port) {
  const UdpSocket sender;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::sendto(sender.get(), "abc", 3, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to), 3);
}

/// Size of the next datagram, and whether the kernel's time came with it.
std::pair<ssize_t, bool> received(int socket) {
  pollfd ready{socket, POLLIN, 0};
  EXPECT_EQ(::poll(&ready, 1, 60'000), 1);
  std::array<char, 16> data{};
  iovec buffer{data.data(), data.size()};
  alignas(cmsghdr) std::array<char, 256> control{};
  msghdr message{};
  message.msg_iov = &buffer;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(socket, &message, 0);
  const cmsghdr* part = CMSG_FIRSTHDR(&message);
  return {size, part != nullptr && part->cmsg_type == SCM_TIMESTAMPNS};
}

TEST(UdpSocketTest, ReceivesAndDoesNotBlock) {
  const UdpSocket socket;
  ASSERT_NE(socket.port(), 0);
  char byte = 0;
  EXPECT_EQ(::recv(socket.get(), &byte, 1, 0), -1);
  EXPECT_EQ(errno, EAGAIN);
  send_to(socket.port());
  EXPECT_EQ(received(socket.get()), (std::pair<ssize_t, bool>{3, false}));
}

TEST(UdpSocketTest, ArrivalsAreStampedIfWanted) {
  const UdpSocket socket({.stamps_arrivals = true});
  send_to(socket.port());
  EXPECT_EQ(received(socket.get()), (std::pair<ssize_t, bool>{3, true}));
}

TEST(UdpSocketTest, TheReceiveBufferIsAsWanted) {
  const auto bytes_of = [](const UdpSocket& socket) {
    int bytes = 0;
    socklen_t size = sizeof bytes;
    EXPECT_EQ(::getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &bytes, &size), 0);
    return bytes;
  };
  constexpr int kWanted = 32'768;  // below any system's bound
  EXPECT_EQ(bytes_of(UdpSocket({.receive_buffer = kWanted})), 2 * kWanted) << "Linux reports the double";
  EXPECT_NE(bytes_of(UdpSocket()), 2 * kWanted);
}

TEST(UdpSocketTest, APortThatIsTakenIsReportedAsSuch) {
  const UdpSocket first;
  const auto second = open_udp_socket(first.port());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error(), std::errc::address_in_use);
}

}  // namespace
}  // namespace fleetmap::apps
