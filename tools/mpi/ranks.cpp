#include "mpi/ranks.h"

#include <algorithm>

namespace radar::tools {

namespace {

constexpr uint64_t kPiece = 1u << 30;  // MPI counts in an int
constexpr int kTag = 1;

// Calls `use` with the start and the length of each piece of so many bytes.
template <class Use>
void forEachPiece(uint64_t size, const Use& use) {
  for (uint64_t start = 0; start < size; start += kPiece) use(start, static_cast<int>(std::min(kPiece, size - start)));
}

void sendText(const std::string& text) {
  const uint64_t size = text.size();
  MPI_Send(&size, 1, MPI_UINT64_T, 0, kTag, MPI_COMM_WORLD);
  forEachPiece(size, [&](uint64_t start, int length) {
    MPI_Send(text.data() + start, length, MPI_BYTE, 0, kTag, MPI_COMM_WORLD);
  });
}

std::string receiveText(int rank) {
  uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, rank, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  std::string text(size, '\0');
  forEachPiece(size, [&](uint64_t start, int length) {
    MPI_Recv(text.data() + start, length, MPI_BYTE, rank, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  });
  return text;
}

}  // namespace

MpiSession::MpiSession(int& argc, char**& argv) {
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine);
  MPI_Comm_rank(machine, &localRank_);
  MPI_Comm_size(machine, &localCount_);
  MPI_Comm_free(&machine);
  outgoing_.resize(3 * static_cast<size_t>(count_) * (sizeof(Chunk) + MPI_BSEND_OVERHEAD));
  MPI_Buffer_attach(outgoing_.data(), static_cast<int>(outgoing_.size()));
}

MpiSession::~MpiSession() {
  void* outgoing = nullptr;
  int size = 0;
  MPI_Buffer_detach(&outgoing, &size);
  MPI_Finalize();
}

std::string hostName() {
  char name[MPI_MAX_PROCESSOR_NAME] = {};
  int length = 0;
  MPI_Get_processor_name(name, &length);
  return {name, static_cast<size_t>(length)};
}

bool broadcast(bool value) {
  int number = value ? 1 : 0;
  MPI_Bcast(&number, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return number == 1;
}

std::vector<std::string> gather(const std::string& text) {
  int rank = 0, count = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  if (rank > 0) {
    sendText(text);
    return {};
  }
  std::vector<std::string> all{text};
  for (int other = 1; other < count; ++other) all.push_back(receiveText(other));
  return all;
}

void send(int rank, Chunk chunk) {
  MPI_Bsend(&chunk, sizeof chunk, MPI_BYTE, rank, kTag, MPI_COMM_WORLD);
}

Chunk receiveChunk() {
  Chunk chunk;
  MPI_Recv(&chunk, sizeof chunk, MPI_BYTE, 0, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return chunk;
}

void send(const Answered& answered) {
  const ChunkReport& report = answered;
  MPI_Send(&report, sizeof report, MPI_BYTE, 0, kTag, MPI_COMM_WORLD);
  sendText(answered.text);
}

std::optional<Received> receiveIfAny() {
  int isThere = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &isThere, &status);
  if (isThere == 0) return std::nullopt;
  Received received{status.MPI_SOURCE, {}};
  ChunkReport& report = received.answered;
  MPI_Recv(&report, sizeof report, MPI_BYTE, received.rank, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  received.answered.text = receiveText(received.rank);
  return received;
}

}  // namespace radar::tools
