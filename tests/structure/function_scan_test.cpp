#include "function_scan.hpp"

#include <gtest/gtest.h>

namespace fleetmap::structure {
namespace {

TEST(FunctionScan, FindsFunctionsInNamespacesAndClassesAndTheirLines) {
  const auto found = functions_in(R"(namespace a {
struct B {
  int c = 0;
  int get() const { return c; }
};

template <class T>
T twice(T x) {
  for (int k = 0; k < 2; ++k) {
    x += x;
  }
  return x;
}
}  // namespace a
)");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].header, "int get() const");
  EXPECT_EQ(found[0].line, 4);
  EXPECT_EQ(found[0].lines, 1);
  EXPECT_EQ(found[1].line, 8);
  EXPECT_EQ(found[1].lines, 6);
}

TEST(FunctionScan, ASignatureOfSeveralLinesBeginsAtItsBrace) {
  const auto found = functions_in("Result<int> sum(int a,\n                int b) {\n  return a + b;\n}\n");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].line, 2);
  EXPECT_EQ(found[0].lines, 3);
}

TEST(FunctionScan, TypesTablesAndBracesInTextAreNoFunctions) {
  EXPECT_TRUE(
      functions_in("enum class A : int {\n  kB,\n};\nconstexpr int kTable[] = {\n  1,\n};\n").empty());
  const auto found = functions_in(R"x(#define OPEN {
void f() {
  // }
  g("}", '}', "\"}");  /* } */
  h(R"y(
}
)y", 10'000);
}
)x");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].lines, 7);
}

}  // namespace
}  // namespace fleetmap::structure
