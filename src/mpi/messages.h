// What processes tell each other (leader.h, follower.h).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/own_file.h"
#include "mpi/post.h"

namespace troffer {

enum class MessageKind : uint32_t {
  // To rank 0.
  want,  // of job `job`, `count` items more
  done,  // item `item` of it, by what follows; one item more is wanted. count: the bits of a float,
         // seconds of the processor
  ask,   // results of the job have not come
  left,  // the process takes no part any more, for the reason that follows
  halt,  // the process was asked to stop: all should
  bye,   // it knows that nothing more will come
  // From rank 0.
  lease,   // item `item` is to be done; what is to be known for it follows
  result,  // piece `item` of `count` of what the job has come to
  repeat,  // … that nobody else is to be told by way of this process
  stop,    // work is to end
  end,     // nothing more will come
  alive
};

struct MessageHeader {
  MessageKind kind{};
  uint32_t count = 0;
  uint64_t job = 0, item = 0;
};
static_assert(sizeof(MessageHeader) == 24);

inline Post::Bytes message(const MessageHeader& header, std::span<const uint8_t> rest = {}) {
  auto bytes = std::make_shared<std::vector<uint8_t>>();
  bytes->reserve(sizeof(header) + rest.size());
  append(*bytes, header);
  bytes->insert(bytes->end(), rest.begin(), rest.end());
  return bytes;
}

inline MessageHeader header_of(const Message& l) {
  return ByteReader(l.bytes).next<MessageHeader>();
}
inline std::span<const uint8_t> rest_of(const Message& l) {
  return std::span(l.bytes).subspan(sizeof(MessageHeader));
}

}  // namespace troffer
