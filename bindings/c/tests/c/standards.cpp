// Compiled once for C++17 and once for C++20, and linked into one program: spans pass between both parts.

#include "darboux.hpp"

std::uint32_t sum(darboux::span<const std::uint32_t> numbers);

#if __cplusplus < 202002L

std::uint32_t sum(darboux::span<const std::uint32_t> numbers) {
  std::uint32_t sum = 0;
  for (const std::uint32_t number : numbers) sum += number;
  return sum;
}

#else

#include <span>

int main() {
  std::vector<std::uint32_t> numbers = {1, 2, 3};
  const std::span<std::uint32_t> written = darboux::span<std::uint32_t>(numbers);
  written[0] = 10;
  const std::span<const std::uint32_t> read = darboux::span<const std::uint32_t>(numbers);
  return sum(read) == 15 && sum(numbers) == 15 ? 0 : 1;
}

#endif
