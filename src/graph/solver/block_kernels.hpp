#pragma once

namespace fleetmap::graph {

/// Products of the small dense blocks of a sparse factorisation, stored column by column, of 3 or 6 rows and
/// columns. Processors with AVX2 use wider registers; these compute the same operations in the same order,
/// never fused, so all robots get the same bits.
///
/// Written by hand because Eigen uses the registers of the compiler's target, which is any x86-64: a product
/// of two 6 x 6 blocks takes 15.6 ns with AVX2, 20.4 ns without, and 18.6 ns with Eigen (bench_cholesky).
struct BlockKernels {
  /// A_ik -= L_ij L_kj^T.
  using Subtract = void (*)(double* a_ik, const double* l_ij, const double* l_kj);
  /// Z_ij -= Z_ik U_kj, and Z_kj -= Z_ik^T U_ij; each only if its U is not null.
  using SubtractBoth = void (*)(const double* z_ik, const double* u_kj, const double* u_ij, double* z_ij,
                                double* z_kj);

  Subtract subtract[2][2][2];           ///< [i][k][j]: 0 for 3, 1 for 6 numbers
  SubtractBoth subtract_both[2][2][2];  ///< likewise

  Subtract subtraction(int i, int k, int j) const { return subtract[i == 6][k == 6][j == 6]; }
  SubtractBoth subtraction_of_both(int i, int k, int j) const {
    return subtract_both[i == 6][k == 6][j == 6];
  }
};

/// The kernels for this processor.
const BlockKernels& block_kernels();
/// The kernels that any processor runs.
const BlockKernels& plain_block_kernels();

}  // namespace fleetmap::graph
