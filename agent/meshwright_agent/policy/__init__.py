"""The policy: network, inference, files, single episodes, and what its decisions rest on."""
