#pragma once

#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <string>

#include "content.hpp"
#include "fleetmap/core/thread_pool.hpp"

namespace fleetmap::monitor {

/// Decodes the first points of every shown submap before a viewer asks for them, on threads beside the
/// server's. Used by the server's thread alone, which hands out the work and keeps what comes back.
class PreviewMaker {
 public:
  /// `io` is run by the server's thread. In the `background`, all other work of the machine goes first.
  PreviewMaker(boost::asio::io_context& io, Content& content, unsigned threads, bool background)
      : io_(io), content_(content), threads_(threads), background_(background), pool_(threads) {}

  /// Goes on with what is shown now.
  void refresh();

 private:
  void start_one();

  boost::asio::io_context& io_;
  Content& content_;
  unsigned threads_;
  bool background_;
  unsigned given_ = 0;  ///< to the pool, and not back yet
  ThreadPool pool_;     ///< last: its threads end first
};

}  // namespace fleetmap::monitor
