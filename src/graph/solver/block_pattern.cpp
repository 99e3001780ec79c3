#include "solver/block_pattern.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

namespace fleetmap::graph {

BlockPattern::BlockPattern(std::vector<int> dims, const std::vector<std::pair<int, int>>& pairs,
                           const std::vector<int>& order)
    : dims_(std::move(dims)) {
  for (const int dim : dims_) {
    offset_.push_back(size_);
    size_ += static_cast<std::size_t>(dim);
  }
  to_column_.resize(dims_.size());
  if (order.empty()) {
    order_by_degree(pairs);
  } else {
    for (std::size_t k = 0; k < order.size(); ++k)
      to_column_[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  }
  place_blocks(pairs);
}

void BlockPattern::order_by_degree(const std::vector<std::pair<int, int>>& pairs) {
  const int n = static_cast<int>(dims_.size());
  std::vector<Eigen::Triplet<double>> triplets;
  for (int i = 0; i < n; ++i) triplets.emplace_back(i, i, 1.0);
  for (const auto& [i, j] : pairs) {
    triplets.emplace_back(i, j, 1.0);
    triplets.emplace_back(j, i, 1.0);
  }
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern, order);
  // order.indices()(k) is the variable that is eliminated as the k-th.
  for (int k = 0; k < n; ++k) to_column_[static_cast<std::size_t>(order.indices()(k))] = k;
}

void BlockPattern::place_blocks(const std::vector<std::pair<int, int>>& pairs) {
  std::vector<std::vector<int>> below(dims_.size());
  for (const auto& [i, j] : pairs) {
    const int a = column_of(i), b = column_of(j);
    if (a != b) below[static_cast<std::size_t>(std::min(a, b))].push_back(std::max(a, b));
  }
  columns_.resize(dims_.size());
  for (std::size_t i = 0; i < dims_.size(); ++i)
    columns_[static_cast<std::size_t>(to_column_[i])].dim = dims_[i];
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    Column& column = columns_[k];
    std::vector<int>& rows = below[k];
    std::ranges::sort(rows);
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    // The elimination of this column fills its parent with all other rows of it.
    if (rows.size() > 1) {
      std::vector<int>& parent = below[static_cast<std::size_t>(rows.front())];
      parent.insert(parent.end(), rows.begin() + 1, rows.end());
    }
    column.diagonal = values_;
    values_ += static_cast<std::size_t>(column.dim * column.dim);
    column.first = rows_.size();
    for (const int row : rows) {
      rows_.push_back({row, values_});
      values_ += static_cast<std::size_t>(column.dim * this->column(row).dim);
    }
    column.end = rows_.size();
    rows = {};
  }
}

std::optional<std::size_t> BlockPattern::find(int row, int column) const {
  const Column& c = this->column(column);
  if (row == column) return c.diagonal;
  const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(c.first);
  const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(c.end);
  const auto found = std::ranges::lower_bound(first, end, row, {}, &Row::row);
  if (found == end || found->row != row) return std::nullopt;
  return found->at;
}

int BlockPattern::root(int column) const {
  for (int above = parent(column); above >= 0; above = parent(column)) column = above;
  return column;
}

}  // namespace fleetmap::graph
