#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace fleetmap::odometry {

/// A vector in blocks: growing moves nothing and never holds twice the memory, and elements stay where they
/// are.
template <class T>
class BlockVector {
 public:
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return blocks_.size() * sizeof(std::array<T, kBlock>); }
  T& operator[](std::size_t i) { return (*blocks_[i / kBlock])[i % kBlock]; }
  const T& operator[](std::size_t i) const { return (*blocks_[i / kBlock])[i % kBlock]; }

  T& push_back(const T& value) {
    if (size_ == blocks_.size() * kBlock) blocks_.push_back(std::make_unique<std::array<T, kBlock>>());
    return (*this)[size_++] = value;
  }
  /// Keeps the first `size` elements.
  void shrink(std::size_t size) {
    size_ = size;
    blocks_.resize((size + kBlock - 1) / kBlock);
  }

 private:
  static constexpr std::size_t kBlock = 1024;
  std::vector<std::unique_ptr<std::array<T, kBlock>>> blocks_;
  std::size_t size_ = 0;
};

}  // namespace fleetmap::odometry
