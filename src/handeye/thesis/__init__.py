"""What the thesis states, and the experiments that check it: only here are its numbers known."""
