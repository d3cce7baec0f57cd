#include "client/sector_stream.h"

#include "client/interrupt.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <utility>

namespace drtv::client {
namespace {

constexpr auto interrupted_pull = "interrupted; the same command goes on where this one ended";

// Makes files of the messages.
class Arrivals {
  public:
    explicit Arrivals(FileWriters& writers) : writers_(writers) {}

    // Takes the bytes out of the message.
    [[nodiscard]] cli::Result<void> take(v1::PullSectorsResponse& message) {
        for (v1::PackedFile& file : *message.mutable_pack()) {
            if (auto pushed = push({file.coordinate(), file.sha256(), std::move(*file.mutable_data())});
                !pushed)
                return pushed;
        }
        if (message.has_sector()) {
            const v1::Sector& sector = message.sector();
            begun_ = {sector.coordinate(), sector.sha256(), ""};
            begun_bytes_ = static_cast<std::size_t>(sector.size_bytes());
        }
        if (message.data().empty())
            return {};
        begun_.bytes += message.data();
        if (begun_.bytes.size() < begun_bytes_)
            return {};
        return push(std::move(begun_));
    }

    [[nodiscard]] int count() const { return count_; }

  private:
    cli::Result<void> push(ArrivedFile file) {
        ++count_;
        return writers_.push(std::move(file));
    }

    FileWriters& writers_;
    ArrivedFile begun_;
    std::size_t begun_bytes_ = 0;
    int count_ = 0;
};

}  // namespace

cli::Result<std::optional<LostFiles>> stream_sectors(ServerConnection& connection,
                                                     const v1::PullSectorsRequest& wanted,
                                                     FileWriters& writers) {
    grpc::ClientContext context;
    const InterruptGuard guard(context, interrupted_pull);
    const auto reader = connection.sectors->PullSectors(&context, wanted);
    Arrivals arrivals(writers);
    v1::PullSectorsResponse message;
    cli::Result<void> taken;
    while (taken && !interrupted() && reader->Read(&message))
        taken = arrivals.take(message);
    if (!taken || interrupted())
        context.TryCancel();
    const grpc::Status status = reader->Finish();
    if (interrupted())
        return cli::fail(cli::exit_interrupted, interrupted_pull);
    if (!taken)
        return tl::unexpected(taken.error());
    if (status.error_code() == grpc::StatusCode::DATA_LOSS)
        return LostFiles{wanted.sectors_size() - arrivals.count(), connection.failure(status)};
    if (!status.ok())
        return tl::unexpected(connection.failure(status));
    if (arrivals.count() < wanted.sectors_size())
        return cli::fail(cli::exit_server,
                         fmt::format("bakerd sent {} of {} files", arrivals.count(), wanted.sectors_size()));
    return std::nullopt;
}

}  // namespace drtv::client
