#include "solver/block_kernels.hpp"

#include <cstring>
#include <type_traits>

#if defined(__x86_64__)
#define FLEETMAP_WIDE [[gnu::target("avx2")]]  // without fma
#else
#define FLEETMAP_WIDE
#endif
#define FLEETMAP_INLINE [[gnu::always_inline]] inline

namespace fleetmap::graph {
namespace {

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));

/// A(R x C) -= L(R x N) M(N x C), where the argument `m` is M or, if kTransposed, its transpose.
template <int R, int N, int C, bool kTransposed>
FLEETMAP_INLINE void subtract_product(double* a, const double* l, const double* m) {
  using Upper = std::conditional_t<R == 6, Four, Two>;
  using Lower = std::conditional_t<R == 6, Two, double>;
  constexpr int kUpper = sizeof(Upper) / sizeof(double);
  for (int c = 0; c < C; ++c, a += R) {
    Upper sum{};
    Lower rest{};
    for (int n = 0; n < N; ++n) {
      const double factor = kTransposed ? m[n * C + c] : m[c * N + n];
      Upper upper;
      Lower lower;
      std::memcpy(&upper, l + n * R, sizeof(Upper));
      std::memcpy(&lower, l + n * R + kUpper, sizeof(Lower));
      sum = n == 0 ? upper * factor : sum + upper * factor;
      rest = n == 0 ? lower * factor : rest + lower * factor;
    }
    Upper upper;
    Lower lower;
    std::memcpy(&upper, a, sizeof(Upper));
    std::memcpy(&lower, a + kUpper, sizeof(Lower));
    upper -= sum;
    lower -= rest;
    std::memcpy(a, &upper, sizeof(Upper));
    std::memcpy(a + kUpper, &lower, sizeof(Lower));
  }
}

template <int I, int K, int J>
FLEETMAP_INLINE void both(const double* z_ik, const double* u_kj, const double* u_ij, double* z_ij,
                          double* z_kj) {
  if (u_kj != nullptr) subtract_product<I, K, J, false>(z_ij, z_ik, u_kj);
  if (u_ij == nullptr) return;
  double z_ki[K * I];
  for (int k = 0; k < K; ++k)
    for (int i = 0; i < I; ++i) z_ki[i * K + k] = z_ik[k * I + i];
  subtract_product<K, I, J, false>(z_kj, z_ki, u_ij);
}

struct Plain {
  template <int I, int K, int J>
  static void subtract(double* a_ik, const double* l_ij, const double* l_kj) {
    subtract_product<I, J, K, true>(a_ik, l_ij, l_kj);
  }
  template <int I, int K, int J>
  static void subtract_both(const double* z_ik, const double* u_kj, const double* u_ij, double* z_ij,
                            double* z_kj) {
    both<I, K, J>(z_ik, u_kj, u_ij, z_ij, z_kj);
  }
};

struct Wide {
  template <int I, int K, int J>
  FLEETMAP_WIDE static void subtract(double* a_ik, const double* l_ij, const double* l_kj) {
    subtract_product<I, J, K, true>(a_ik, l_ij, l_kj);
  }
  template <int I, int K, int J>
  FLEETMAP_WIDE static void subtract_both(const double* z_ik, const double* u_kj, const double* u_ij,
                                          double* z_ij, double* z_kj) {
    both<I, K, J>(z_ik, u_kj, u_ij, z_ij, z_kj);
  }
};

template <class Set>
constexpr BlockKernels kKernels{
    {{{Set::template subtract<3, 3, 3>, Set::template subtract<3, 3, 6>},
      {Set::template subtract<3, 6, 3>, Set::template subtract<3, 6, 6>}},
     {{Set::template subtract<6, 3, 3>, Set::template subtract<6, 3, 6>},
      {Set::template subtract<6, 6, 3>, Set::template subtract<6, 6, 6>}}},
    {{{Set::template subtract_both<3, 3, 3>, Set::template subtract_both<3, 3, 6>},
      {Set::template subtract_both<3, 6, 3>, Set::template subtract_both<3, 6, 6>}},
     {{Set::template subtract_both<6, 3, 3>, Set::template subtract_both<6, 3, 6>},
      {Set::template subtract_both<6, 6, 3>, Set::template subtract_both<6, 6, 6>}}}};

bool is_wide() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace

const BlockKernels& block_kernels() {
  static const BlockKernels& kernels = is_wide() ? kKernels<Wide> : kKernels<Plain>;
  return kernels;
}

const BlockKernels& plain_block_kernels() { return kKernels<Plain>; }

}  // namespace fleetmap::graph
