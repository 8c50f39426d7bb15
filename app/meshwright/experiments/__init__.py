"""Research in notebooks: policies compared, many meshes at once, learning curves, what a policy
sees, the blocks of a mesh. Everything returns data, and shows itself as a picture.

PyTorch is imported when a policy is asked for, and no earlier.
"""

from app.experiments.block_view import BlockView, block_view
from app.experiments.comparison import Comparison, compare
from app.experiments.learning import Curves, learning_curves
from app.experiments.multiples import Multiples, small_multiples
from app.experiments.pair import side_by_side
from app.experiments.picture import Picture
from app.experiments.policy_view import PolicyView, policy_view
from app.experiments.runs import Rollout
from app.experiments.table_row import TableRow, table_row

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
