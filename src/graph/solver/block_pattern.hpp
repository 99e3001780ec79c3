#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace fleetmap::graph {

/// Symbolic factorisation A = L L^T of a sparse symmetric matrix of small dense blocks: the elimination order
/// of the variables, and where L has blocks (Davis, "Direct Methods for Sparse Linear Systems", ch. 4).
class BlockPattern {
 public:
  struct Column {
    int dim = 0;
    std::size_t diagonal = 0;  ///< offset of the diagonal block in the values
    std::size_t first = 0;     ///< in rows(), of the blocks below the diagonal
    std::size_t end = 0;
  };
  struct Row {
    int row = 0;
    std::size_t at = 0;  ///< offset of the block in the values
  };

  /// `dims` of the variables (3 or 6), and the pairs of variables that share a factor. They are eliminated in
  /// `order`, or by approximate minimum degree (AMD) if it is empty.
  BlockPattern(std::vector<int> dims, const std::vector<std::pair<int, int>>& pairs,
               const std::vector<int>& order);

  std::size_t variables() const { return dims_.size(); }
  int column_of(int variable) const { return to_column_[static_cast<std::size_t>(variable)]; }
  /// First element of a variable in a vector that keeps the order of the variables.
  std::size_t offset(int variable) const { return offset_[static_cast<std::size_t>(variable)]; }
  /// Elements of such a vector.
  std::size_t size() const { return size_; }

  const std::vector<Column>& columns() const { return columns_; }
  const Column& column(int k) const { return columns_[static_cast<std::size_t>(k)]; }
  /// Blocks below the diagonal, column by column, ascending.
  const std::vector<Row>& rows() const { return rows_; }
  /// Elements of all blocks.
  std::size_t values() const { return values_; }
  /// Offset of a block on or below the diagonal; none where L has no block.
  std::optional<std::size_t> find(int row, int column) const;

  /// Parent of a column in the elimination tree; -1 for a root.
  int parent(int column) const {
    const Column& c = this->column(column);
    return c.first == c.end ? -1 : rows_[c.first].row;
  }
  int root(int column) const;

 private:
  void order_by_degree(const std::vector<std::pair<int, int>>& pairs);
  void place_blocks(const std::vector<std::pair<int, int>>& pairs);

  std::vector<int> dims_;  ///< by variable
  std::vector<int> to_column_;
  std::vector<std::size_t> offset_;
  std::size_t size_ = 0;
  std::vector<Column> columns_;
  std::vector<Row> rows_;
  std::size_t values_ = 0;
};

}  // namespace fleetmap::graph
