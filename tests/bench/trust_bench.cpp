// CPU of seals and signatures.
#include <benchmark/benchmark.h>
#include <openssl/evp.h>

#include <memory>

#include "fleetmap/trust/datagram.hpp"
#include "fleetmap/trust/introduction.hpp"
#include "fleetmap/trust/item_signature.hpp"
#include "trust/fleet_of_keys.hpp"

namespace fleetmap::trust {
namespace {

using testing::FleetOfKeys;
using testing::kNow;

constexpr std::int64_t kDatagrams[] = {64, 300, 1400};

/// The two ciphers of TLS 1.3 as OpenSSL has them, the key schedule kept.
void seal_with(benchmark::State& state, const EVP_CIPHER* cipher) {
  const std::unique_ptr<EVP_CIPHER_CTX, decltype(&EVP_CIPHER_CTX_free)> context(EVP_CIPHER_CTX_new(),
                                                                                &EVP_CIPHER_CTX_free);
  const SecretKey key{1, 2, 3};
  std::array<std::uint8_t, 12> nonce{};
  const Bytes text(static_cast<std::size_t>(state.range(0)), 7);
  Bytes sealed(text.size() + kTagBytes);
  EVP_EncryptInit_ex(context.get(), cipher, nullptr, key.data(), nullptr);
  for (auto _ : state) {
    int size = 0;
    ++nonce[0];
    EVP_EncryptInit_ex(context.get(), nullptr, nullptr, nullptr, nonce.data());
    EVP_EncryptUpdate(context.get(), nullptr, &size, nonce.data(), 10);
    EVP_EncryptUpdate(context.get(), sealed.data(), &size, text.data(), static_cast<int>(text.size()));
    EVP_EncryptFinal_ex(context.get(), sealed.data() + size, &size);
    EVP_CIPHER_CTX_ctrl(context.get(), EVP_CTRL_AEAD_GET_TAG, kTagBytes, sealed.data() + text.size());
    benchmark::DoNotOptimize(sealed.data());
  }
}
void aes_256_gcm(benchmark::State& state) { seal_with(state, EVP_aes_256_gcm()); }
void chacha20_poly1305(benchmark::State& state) { seal_with(state, EVP_chacha20_poly1305()); }
BENCHMARK(aes_256_gcm)->Arg(kDatagrams[0])->Arg(kDatagrams[1])->Arg(kDatagrams[2]);
BENCHMARK(chacha20_poly1305)->Arg(kDatagrams[0])->Arg(kDatagrams[1])->Arg(kDatagrams[2]);

void seal_datagram(benchmark::State& state) {
  const Credentials member = FleetOfKeys().member("r1");
  DatagramSealer sealer(member, member.certificate.name, 1, draw_session({1, 15}));
  const Bytes text(static_cast<std::size_t>(state.range(0)), 7);
  for (auto _ : state) benchmark::DoNotOptimize(sealer.seal(DatagramKind::kMessage, text));
}
BENCHMARK(seal_datagram)->Arg(kDatagrams[0])->Arg(kDatagrams[1])->Arg(kDatagrams[2]);

void seal_and_open_datagram(benchmark::State& state) {
  const Credentials member = FleetOfKeys().member("r1");
  const Session session = draw_session({1, 15});
  DatagramSealer sealer(member, member.certificate.name, 1, session);
  DatagramOpener opener(member, 1);
  const Bytes text(static_cast<std::size_t>(state.range(0)), 7);
  if (!opener.open(sealer.seal(DatagramKind::kGreeting, text)) || !opener.admit(session, Role::kRobot))
    return state.SkipWithError("not admitted");
  for (auto _ : state) {
    if (!opener.open(sealer.seal(DatagramKind::kMessage, text))) return state.SkipWithError("not opened");
  }
}
BENCHMARK(seal_and_open_datagram)->Arg(kDatagrams[0])->Arg(kDatagrams[1])->Arg(kDatagrams[2]);

void introduce_and_verify(benchmark::State& state) {
  FleetOfKeys fleet;
  const Credentials first = fleet.member("r1"), second = fleet.member("r2");
  const Session session = draw_session({1, 15});
  const Introducer sender(first, 1, session);
  Introducer listener(second, 1, draw_session({1, 15}));
  const Bytes hello(150, 7);
  for (auto _ : state) {
    const auto read = parse_introduction(sender.introduce(hello, {.names_you = true}, true, true));
    if (!listener.verify(*read, session, kNow)) return state.SkipWithError("not verified");
  }
}
BENCHMARK(introduce_and_verify);

void sign_item_of(benchmark::State& state) {
  const SigningKey maker = SigningKey::generate();
  const Bytes node(static_cast<std::size_t>(state.range(0)), 7);
  for (auto _ : state) benchmark::DoNotOptimize(sign_item(maker, {}, ItemKind::kNode, node));
}
BENCHMARK(sign_item_of)->Arg(270);

void verify_item_of(benchmark::State& state) {
  const SigningKey maker = SigningKey::generate();
  const Bytes node(static_cast<std::size_t>(state.range(0)), 7);
  const Signature signature = sign_item(maker, {}, ItemKind::kNode, node);
  for (auto _ : state)
    benchmark::DoNotOptimize(verify_item(maker.public_key(), {}, ItemKind::kNode, node, signature));
}
BENCHMARK(verify_item_of)->Arg(270);

}  // namespace
}  // namespace fleetmap::trust
