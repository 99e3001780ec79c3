#include "datagram_input.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <utility>

#include "fleetmap/core/utc.hpp"
#include "udp_socket.hpp"

namespace fleetmap::apps {
namespace {

/// Another device may take over after the first one was silent for so long.
constexpr Duration kDeviceSilence = std::chrono::seconds(5);
/// A second of a VLP-16, a tenth of the largest Ouster; the system grants up to net.core.rmem_max.
constexpr int kReceiveBuffer = 4 << 20;
constexpr int kDatagramPollMilliseconds = 100;
constexpr std::size_t kMaxDatagramBytes = 65'536;

std::string address_text(std::uint32_t address) {
  char text[INET_ADDRSTRLEN] = {};
  const in_addr in{htonl(address)};
  inet_ntop(AF_INET, &in, text, sizeof text);
  return text;
}

/// When the system received a datagram.
Stamp arrival_of(msghdr& message) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec time{};
    std::memcpy(&time, CMSG_DATA(part), sizeof time);
    return stamp_from_ns(std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec);
  }
  return system_now();
}

}  // namespace

Result<std::unique_ptr<DatagramInput>> DatagramInput::open(std::uint16_t port, const std::string& key,
                                                           const std::string& topic, OnDatagram on_datagram) {
  const auto socket = open_udp_socket(port, {.receive_buffer = kReceiveBuffer, .stamps_arrivals = true});
  if (!socket) {
    const bool is_taken = socket.error() == std::errc::address_in_use;
    return failure(key + " " + std::to_string(port) + ": " +
                   (is_taken ? "another program receives there; end it, or take its topic as " + topic
                             : socket.error().message()));
  }
  return std::unique_ptr<DatagramInput>(
      new DatagramInput(*socket, udp_port_of(*socket), std::move(on_datagram)));
}

DatagramInput::DatagramInput(int socket, std::uint16_t port, OnDatagram on_datagram)
    : socket_(socket),
      port_(port),
      on_datagram_(std::move(on_datagram)),
      buffer_(kMaxDatagramBytes),
      thread_([this](const std::stop_token& stop) { receive(stop); }) {}

DatagramInput::~DatagramInput() {
  thread_.request_stop();
  thread_.join();
  ::close(socket_);
}

DatagramInput::Counters DatagramInput::counters() const {
  const std::scoped_lock lock(mutex_);
  return counters_;
}

void DatagramInput::receive(const std::stop_token& stop) {
  pollfd ready{socket_, POLLIN, 0};
  while (!stop.stop_requested()) {
    if (::poll(&ready, 1, kDatagramPollMilliseconds) <= 0) continue;
    while (const auto datagram = read()) {
      handle(*datagram);
      if (stop.stop_requested()) return;
    }
  }
}

std::optional<DatagramInput::Datagram> DatagramInput::read() {
  sockaddr_in from{};
  iovec data{buffer_.data(), buffer_.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(timespec))] = {};
  msghdr message{};
  message.msg_name = &from;
  message.msg_namelen = sizeof from;
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const ssize_t size = ::recvmsg(socket_, &message, 0);
  if (size < 0) return std::nullopt;
  return Datagram{ByteView(buffer_).first(static_cast<std::size_t>(size)), ntohl(from.sin_addr.s_addr),
                  arrival_of(message)};
}

/// The first address from which a packet came, or another one when it fell silent.
bool DatagramInput::is_device(const Datagram& datagram) const {
  return !device_ || *device_ == datagram.source || datagram.arrival - last_packet_ > kDeviceSilence;
}

void DatagramInput::handle(const Datagram& datagram) {
  const bool of_device = is_device(datagram);
  const auto taken = of_device ? on_datagram_(datagram.payload, datagram.arrival)
                               : tl::expected<void, sensor::PacketRefusal>();
  if (of_device && taken) {
    device_ = datagram.source;
    last_packet_ = datagram.arrival;
  }
  if (!of_device)
    count(&Counters::of_other_devices, "packets come from " + address_text(datagram.source) +
                                           ", too, not only from " + address_text(*device_) +
                                           "; give each LiDAR a port of its own");
  if (!taken) count(&Counters::refused, "refused: " + taken.error().what);
  const std::scoped_lock lock(mutex_);
  ++counters_.datagrams;
}

void DatagramInput::count(std::uint64_t Counters::*counter, const std::string& what) {
  const std::scoped_lock lock(mutex_);
  const std::uint64_t count = ++(counters_.*counter);
  if (count == 1 || count == 10 || count == 100 || count % 1000 == 0)
    spdlog::warn("UDP port {} ({} so far): {}", port_, count, what);
}

}  // namespace fleetmap::apps
