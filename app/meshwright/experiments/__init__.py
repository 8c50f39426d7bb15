"""Experiments for notebooks: policies compared, many meshes in one picture, learning curves, the
input and output of a policy at a half-edge, the blocks of a mesh. Each function returns data that
displays itself as a picture.

PyTorch is imported when a policy is loaded, matplotlib when a chart is drawn.
"""

from meshwright.experiments.block_view import BlockView, block_view
from meshwright.experiments.comparison import Comparison, compare
from meshwright.experiments.learning import Curves, learning_curves
from meshwright.experiments.picture import Picture
from meshwright.experiments.policy_view import PolicyView, policy_view
from meshwright.experiments.rollouts import Rollout
from meshwright.experiments.side_by_side import side_by_side
from meshwright.experiments.small_multiples import Multiples, small_multiples
from meshwright.experiments.table_row import TableRow, table_row

__all__ = [
    "BlockView",
    "Comparison",
    "Curves",
    "Multiples",
    "Picture",
    "PolicyView",
    "Rollout",
    "TableRow",
    "block_view",
    "compare",
    "learning_curves",
    "policy_view",
    "side_by_side",
    "small_multiples",
    "table_row",
]
