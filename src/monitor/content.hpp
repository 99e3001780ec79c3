#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/monitor/fleet_view.hpp"
#include "fleetmap/monitor/live_status.hpp"
#include "fleetmap/monitor/server.hpp"
#include "point_levels.hpp"
#include "preview_file.hpp"

namespace fleetmap::monitor {

struct Reply {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  bool gzip = false;
  bool immutable = false;  ///< named by its content, so that a browser may keep it for ever
};

/// Submaps ready to be sent, those asked for last: at most so many bytes, but at least one.
class PointCache {
 public:
  explicit PointCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}
  std::shared_ptr<const QuantisedCloud> find(const std::string& hash);
  void keep(const std::string& hash, std::shared_ptr<const QuantisedCloud> cloud);

 private:
  struct Entry {
    std::string hash;
    std::shared_ptr<const QuantisedCloud> cloud;
  };
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::list<Entry> entries_;  ///< the one used last in front
  std::map<std::string, std::list<Entry>::iterator> by_hash_;
};

/// Content of the server: the page's files, the state and the submaps. No path is ever opened as a file. Used
/// by one thread; only the work of begin_preview() is done on others.
class Content {
 public:
  /// Points of a submap that come with those of others at most.
  static constexpr std::size_t kCoarsePoints = 1024;
  /// Submaps that one answer decodes, so that other requests wait for some 0.1 s at most.
  static constexpr std::size_t kDecodedAtOnce = 16;
  /// Likewise, while others are decoded on other threads.
  static constexpr std::size_t kDecodedBesideOthers = 4;
  using Cloud = std::shared_ptr<const QuantisedCloud>;
  /// Decodes one submap, on any thread.
  using Make = std::function<Cloud()>;

  /// `load` is called on several threads at a time if previews are made.

  Content(std::span<const PageFile> page, LoadSubmap load, std::size_t cached_bytes)
      : page_(page), load_(std::move(load)), cache_(cached_bytes), coarse_(cached_bytes) {}

  void show(const FleetView& view);
  void show(const LiveStatus& status, bool operated);
  /// The state as JSON; "{}" before the first show().
  std::shared_ptr<const std::string> state() const { return state_; }
  /// The live status as JSON; empty before the first show().
  std::shared_ptr<const std::string> live() const { return live_; }
  Reply reply(std::string_view target);
  /// The first points of some submap were not made yet, and nobody is at it.
  bool misses_previews();
  bool has_preview(const std::string& hash) { return coarse_.find(hash) != nullptr; }
  /// Hands out the next one of these, in an order of which any beginning is spread over the site.
  std::pair<std::string, Make> begin_preview();
  /// Keeps what its work returned.
  void end_preview(const std::string& hash, const Cloud& preview);
  /// Keeps previews that were made before, so that those of submaps that are shown now or later need no work.
  void keep(const Previews& previews);
  /// The previews of the submaps that are shown, as far as they are kept.
  Previews previews();
  /// Number of them that were made since keep() or previews().
  std::size_t new_previews() const { return new_previews_; }
  std::size_t kept_previews() const { return made_.size(); }
  /// A node's submap, of those kept or freshly decoded; it is kept only if the page asks for it (reply()).
  Result<std::shared_ptr<const QuantisedCloud>> cloud(const graph::Node& node);

 private:
  /// A submap's node, and the hash by which the submap is named.
  struct Source {
    NodeId node;
    ContentHash hash{};
  };
  Result<std::shared_ptr<const QuantisedCloud>> cloud(const Source& source, const std::string& hash);
  Reply page_file(std::string_view path) const;
  Reply submap(std::string_view target);
  Reply submaps(std::string_view target);
  /// The first kCoarsePoints of a shown submap, empty where it cannot be read; null for later where they must
  /// be decoded first and `decodable` is 0, or are being made.
  std::shared_ptr<const QuantisedCloud> coarse(const Source& source, const std::string& hash,
                                               std::size_t& decodable);
  void keep_new(const std::string& hash, const Cloud& preview);

  std::span<const PageFile> page_;
  LoadSubmap load_;
  PointCache cache_;
  PointCache coarse_;  ///< first points of the same and of others, so that the whole map is at hand
  std::shared_ptr<const std::string> state_ = std::make_shared<const std::string>("{}");
  std::shared_ptr<const std::string> live_ = std::make_shared<const std::string>();
  std::map<std::string, Source> submaps_;  ///< by content hash
  std::deque<std::string> waiting_;        ///< submaps whose previews are to be made
  std::set<std::string> made_;             ///< of those shown, also if the cache lacks them by now
  std::set<std::string> being_made_;       ///< by the work of begin_preview()
  std::size_t new_previews_ = 0;
};

}  // namespace fleetmap::monitor
