#!/usr/bin/env bash
# fetch_cmu.sh DIR: fetch the CMU Graphics Lab database (ASF/AMC, about 1.2 GB) from the university into DIR.
# Its terms: free for research and commercial use, not to be resold; see http://mocap.cs.cmu.edu.
set -euo pipefail
dir=${1:?usage: fetch_cmu.sh DIR}
for tool in wget unzip; do
  command -v "$tool" >/dev/null || { echo "fetch_cmu.sh: needs $tool: apt-get install wget unzip" >&2; exit 73; }
done
mkdir -p "$dir"
archive=$dir/allasfamc.zip
wget --continue --output-document "$archive" http://mocap.cs.cmu.edu/allasfamc.zip
unzip -q -n "$archive" -d "$dir"
echo "kinetome reindex $dir/all_asfamc/subjects --store cmu.store"
