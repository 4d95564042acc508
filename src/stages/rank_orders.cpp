#include "rank_orders.h"

#include <fmt/format.h>

#include "kinetome/base/packing.h"

namespace kinetome {
namespace {

/// What rank 0 tells the others, who find nothing by themselves: a file system may show them for a
/// while what was, not what is.
struct Orders {
    RunRecord record;
    FinishedPlan finished;
};

Orders unpack_orders(std::string bytes) {
    Unpacker in(std::move(bytes));
    Orders orders;
    orders.record = parse_run_record(in.get_text(), "the run's record");
    orders.record.survey.remedy_for_change = in.get_text();
    orders.finished = unpack_finished(in.get_text());
    return orders;
}

}  // namespace

void order_survey(bool wanted, Communicator& ranks) {
    ranks.broadcast(packed(uint8_t{wanted}));
}

void order_work(const RunPlan& plan, const FinishedPlan& finished, Communicator& ranks) {
    Packer out;
    out.put(std::string_view(write_run_record(plan.survey, plan.options)));
    out.put(std::string_view(plan.survey.remedy_for_change));
    out.put(std::string_view(pack_finished(finished)));
    ranks.broadcast(out.take());
}

void assist(const ReindexRequest& request, const Selection& selection, Communicator& ranks, Log log,
            const StopToken& stop) {
    const bool survey = unpacked<uint8_t>(ranks.broadcast({})) != 0;
    if (survey) {
        const Workers workers(request.resources.threads, &ranks);
        survey_corpus(request.corpus, workers, log, stop);
    }
    Orders orders = unpack_orders(ranks.broadcast({}));
    const RunPlan plan(std::move(orders.record.survey), orders.record.options);
    VerifiedFiles verified;
    const Workspace workspace(StoreDirectory::open(request.store), nullptr, verified);
    log.add_file(workspace.folder() / fmt::format("log-of-rank-{}.txt", ranks.rank()));
    carry_out(plan, std::move(orders.finished), selection,
              {workspace, request.resources, log, stop, ranks});
}

}  // namespace kinetome
