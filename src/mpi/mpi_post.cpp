#include "mpi/mpi_post.h"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <list>

#include "base/error.h"

namespace troffer {

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr int tag = 0;
constexpr size_t large = 4096;          // bytes: more than MPI sends unasked
constexpr auto usual_journey = 1000ms;  // what takes longer may be for the dead

bool is_through(MPI_Request& request) {
  int flag = 0;
  // What cannot be sent is lost.
  return MPI_Test(&request, &flag, MPI_STATUS_IGNORE) != MPI_SUCCESS || flag != 0;
}

}  // namespace

struct MpiPost::Moving {
  struct Out {
    Bytes bytes;
    MPI_Request request = MPI_REQUEST_NULL;
    Clock::time_point since;
  };
  struct In {
    Letter letter;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  std::list<Out> out;
  std::list<In> in;
};

MpiPost::MpiPost(int& argc, char**& argv) : moving_(std::make_unique<Moving>()) {
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  if (provided < MPI_THREAD_SERIALIZED) {
    MPI_Finalize();
    throw EnvironmentError("this MPI cannot be called from more than one thread");
  }
}

// Letters to who is dead never arrive.
MpiPost::~MpiPost() {
  for (Moving::Out& o : moving_->out) MPI_Request_free(&o.request);
  for (Moving::In& i : moving_->in) MPI_Cancel(&i.request);
  MPI_Finalize();
}

std::optional<Letter> MpiPost::receive() {
  int flag = 0;
  MPI_Message message = MPI_MESSAGE_NULL;
  MPI_Status status;
  if (MPI_Improbe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &flag, &message, &status) == MPI_SUCCESS &&
      flag != 0) {
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    Moving::In& in = moving_->in.emplace_back();
    in.letter.from = status.MPI_SOURCE;
    in.letter.bytes.resize(size_t(size));
    MPI_Imrecv(in.letter.bytes.data(), size, MPI_BYTE, &message, &in.request);
  }
  for (auto in = moving_->in.begin(); in != moving_->in.end(); ++in)
    if (is_through(in->request)) {
      Letter letter = std::move(in->letter);
      moving_->in.erase(in);
      return letter;
    }
  return std::nullopt;
}

void MpiPost::send(int to, Bytes bytes) {
  Moving::Out& out = moving_->out.emplace_back();
  out.bytes = std::move(bytes);
  out.since = Clock::now();
  MPI_Isend(out.bytes->data(), int(out.bytes->size()), MPI_BYTE, to, tag, MPI_COMM_WORLD,
            &out.request);
}

bool MpiPost::is_moving() {
  moving_->out.remove_if([](Moving::Out& o) { return is_through(o.request); });
  const Clock::time_point now = Clock::now();
  return !moving_->in.empty() ||
         std::any_of(moving_->out.begin(), moving_->out.end(), [&](const Moving::Out& o) {
           return o.bytes->size() > large && now - o.since < usual_journey;
         });
}

}  // namespace troffer
